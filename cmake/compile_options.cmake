# Warnings, sanitizers, ccache and clang-tidy for every target of this project.
find_program(MADORI_CCACHE ccache)
if(MADORI_CCACHE)
  # What ccache asks for before it keeps what was compiled with headers read ahead (its manual, "Precompiled headers").
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${MADORI_CCACHE})
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
  set(CMAKE_C_COMPILER_LAUNCHER ${MADORI_CCACHE})
endif()

set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
add_compile_options(-pthread)  # some libraries ask for it; headers read ahead are of use to all with it or to all without

add_library(madori_options INTERFACE)
target_include_directories(madori_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(madori_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wimplicit-fallthrough)
target_link_libraries(madori_options INTERFACE Threads::Threads)

if(MADORI_SANITIZE)
  # With sanitizers g++ 12 sees uninitialized and overlapping memory inside std::regex and std::string (GCC PR 105562,
  # PR 105651); the sanitizers themselves would tell.
  target_compile_options(madori_options INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
  target_compile_options(madori_options INTERFACE
    -fsanitize=${MADORI_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(madori_options INTERFACE -fsanitize=${MADORI_SANITIZE})
endif()
if(MADORI_FUZZ)
  target_compile_options(madori_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
set(MADORI_UNITY ON)
if(MADORI_TIDY)
  set(MADORI_UNITY OFF)  # clang-tidy looks at the files as they are written
  find_program(MADORI_CLANG_TIDY NAMES clang-tidy-14 clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${MADORI_CLANG_TIDY} --quiet)
endif()
