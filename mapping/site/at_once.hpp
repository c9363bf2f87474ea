#pragma once

#include <future>
#include <type_traits>
#include <vector>

namespace madori::mapping {

/// work(item) of each of a few items, all at the same time, and what each of them gave, if anything: most of
/// what is done with files is waiting for the disk. Throws what the first of them threw, after all have
/// ended.
template <class Items, class Work>
auto at_once(Items&& items, const Work& work) {
  std::vector<std::future<decltype(work(*items.begin()))>> running;
  for (auto& item : items)
    running.push_back(std::async(std::launch::async, [&work, &item] { return work(item); }));
  if constexpr (std::is_void_v<decltype(work(*items.begin()))>) {
    for (auto& one : running) one.get();
  } else {
    std::vector<decltype(work(*items.begin()))> results;
    for (auto& one : running) results.push_back(one.get());
    return results;
  }
}

}  // namespace madori::mapping
