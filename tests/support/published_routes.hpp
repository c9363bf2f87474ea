#pragma once

namespace madori::test {

/// Tables 2 and 3 of the layout-map paper (Sasaki, Tsuda, Matsushita, Electronics 2024, 13, 1082).
inline constexpr const char* kPublishedTree = "ID,EDA\n0,1\n1,0 2 3\n2,1 3\n3,1 4\n4,3\n5,2\n";
inline constexpr const char* kPublishedPath =
    "ID,x,y\n0,0,0\n1,1.8,-0.1\n2,5.46,-0.61\n3,2.34,1.7\n4,2.46,4.22\n5,5.28,-3.52\n";

}  // namespace madori::test
