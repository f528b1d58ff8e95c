// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/bytes.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "osteon/base/error.h"

namespace osteon::io {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

Bytes read_file(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) throw Error("{}: no such file", path.string());
  if (!std::filesystem::is_regular_file(status)) throw Error("{}: not a regular file", path.string());
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  const File file(std::fopen(path.c_str(), "rb"));
  if (failure || !file) throw Error("{}: cannot read: {}", path.string(), std::strerror(errno));
  if (size == 0) throw Error("{}: the file is empty", path.string());
  Bytes bytes(size);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
    throw Error("{}: cannot read: {}", path.string(), std::strerror(errno));
  return bytes;
}

void write_file(const std::filesystem::path& path, std::span<const std::span<const std::uint8_t>> parts) {
  const std::filesystem::path aside = path.string() + fmt::format(".{}.tmp", ::getpid());
  const auto fail = [&] {
    const int reason = errno;
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw Error("{}: cannot write: {}", path.string(), std::strerror(reason));
  };
  File file(std::fopen(aside.c_str(), "wb"));
  if (!file) fail();
  for (const auto& part : parts)
    if (std::fwrite(part.data(), 1, part.size(), file.get()) != part.size()) fail();
  if (std::fclose(file.release()) != 0) fail();
  if (std::rename(aside.c_str(), path.c_str()) != 0) fail();
}

Bytes utf8_of(Bytes bytes) {
  const std::string_view text = text_of(bytes);
  const bool little = text.starts_with("\xFF\xFE"), big = text.starts_with("\xFE\xFF");
  if (!little && !big) return bytes;
  Bytes out;
  const auto unit = [&](std::size_t i) {
    return static_cast<std::uint32_t>(little ? bytes[i] | bytes[i + 1] << 8 : bytes[i] << 8 | bytes[i + 1]);
  };
  const auto put = [&](std::uint32_t byte) { out.push_back(static_cast<std::uint8_t>(byte)); };
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    std::uint32_t c = unit(i);
    if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size()) {  // the first half of a pair
      i += 2;
      c = 0x10000 + ((c - 0xD800) << 10) + ((unit(i) - 0xDC00) & 0x3FF);
    }
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0 | c >> 6), put(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
      put(0xE0 | c >> 12), put(0x80 | (c >> 6 & 0x3F)), put(0x80 | (c & 0x3F));
    } else {
      put(0xF0 | c >> 18), put(0x80 | (c >> 12 & 0x3F)), put(0x80 | (c >> 6 & 0x3F)), put(0x80 | (c & 0x3F));
    }
  }
  return out;
}

}  // namespace osteon::io
