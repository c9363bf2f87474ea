#include "hmi/server/tar_stream.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/result.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 512;
constexpr std::size_t kPart = 64U << 10U;

/// The header's fields, POSIX.1-1988 (ustar).
struct Field {
  std::size_t at;
  std::size_t size;
};
constexpr Field kName{0, 100}, kMode{100, 8}, kUid{108, 8}, kGid{116, 8}, kSize{124, 12}, kTime{136, 12},
    kSum{148, 8}, kType{156, 1}, kMagic{257, 8}, kPrefix{345, 155};

using Block = std::array<char, kBlock>;

void put(Block& block, Field field, const std::string& text) {
  std::memcpy(block.data() + field.at, text.data(), std::min(text.size(), field.size));
}

void put_octal(Block& block, Field field, std::uint64_t value) {
  std::array<char, 24> digits{};
  (void)std::snprintf(digits.data(), digits.size(), "%0*llo", static_cast<int>(field.size) - 1,
                      static_cast<unsigned long long>(value));
  put(block, field, digits.data());
}

/// A name of more than 100 characters is cut at a slash, its front goes into the prefix field.
void put_name(Block& block, const std::string& name) {
  if (name.size() <= kName.size) return put(block, kName, name);
  const std::size_t slash = name.find('/', name.size() - kName.size - 1);
  if (slash == std::string::npos || slash > kPrefix.size) return put(block, kName, name);
  put(block, kPrefix, name.substr(0, slash));
  put(block, kName, name.substr(slash + 1));
}

std::string header(const std::string& name, std::uint64_t size, std::uint64_t modified_s) {
  Block block{};
  put_name(block, name);
  put_octal(block, kMode, 0644);
  put_octal(block, kUid, 0);
  put_octal(block, kGid, 0);
  put_octal(block, kSize, size);
  put_octal(block, kTime, modified_s);
  put(block, kSum, "        ");
  put(block, kType, "0");
  put(block, kMagic, std::string("ustar\00000", 8));
  unsigned sum = 0;
  for (const char c : block) sum += static_cast<unsigned char>(c);
  std::array<char, 8> digits{};
  (void)std::snprintf(digits.data(), digits.size(), "%06o", sum);
  put(block, kSum, std::string(digits.data(), 7));
  return {block.data(), block.size()};
}

}  // namespace

std::string TarStream::next() {
  if (left_ > 0) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left_, kPart));
    std::string part = open_->read(wanted);
    if (part.size() < wanted)
      throw Error(entries_[at_ - 1].file.string(), "became shorter while it was read, or cannot be read",
                  "try again");
    left_ -= part.size();
    if (left_ == 0) part.append(padding_, '\0');
    return part;
  }
  open_.reset();
  while (at_ < entries_.size()) {
    Entry& entry = entries_[at_++];
    open_ = entry.held ? std::move(entry.held) : HeldFile::open(entry.file);
    if (!open_) continue;  // it was removed meanwhile
    left_ = open_->size();
    padding_ = static_cast<std::size_t>((kBlock - left_ % kBlock) % kBlock);
    return header(entry.name, left_, open_->modified_s());
  }
  if (ended_) return {};
  ended_ = true;
  return std::string(2 * kBlock, '\0');
}

Response tar_response(std::vector<TarStream::Entry> entries, const std::string& file_name) {
  Response response{200, "application/x-tar", "", {}, {}};
  response.headers["Content-Disposition"] = "attachment; filename=\"" + file_name + "\"";
  response.next_part = [tar = std::make_shared<TarStream>(std::move(entries))] { return tar->next(); };
  return response;
}

std::vector<TarStream::Entry> tar_entries(const fs::path& folder, const std::string& prefix) {
  std::vector<TarStream::Entry> entries;
  std::error_code missing;
  for (const auto& entry : fs::recursive_directory_iterator(folder, missing))
    if (entry.is_regular_file() && !entry.is_symlink())
      entries.push_back({entry.path(), prefix + fs::relative(entry.path(), folder).generic_string()});
  std::ranges::sort(entries, {}, &TarStream::Entry::name);
  return entries;
}

}  // namespace madori::hmi
