// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/isolated.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <string>

#include "osteon/base/error.h"

namespace osteon::io {
namespace {

constexpr std::uint8_t kResult = 1, kFailure = 2;  // the first byte of what the child writes

// A file in memory that parent and child share.
class SharedFile {
 public:
  SharedFile() : descriptor_(::memfd_create("osteon", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw Error("cannot make a file in memory: {}", std::strerror(errno));
  }
  ~SharedFile() { ::close(descriptor_); }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  bool write(const void* data, std::size_t size) const {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, bytes, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes += written;
      size -= static_cast<std::size_t>(written);
    }
    return true;
  }

  Bytes content() const {
    struct stat info {};
    if (::fstat(descriptor_, &info) != 0) return {};
    Bytes bytes(static_cast<std::size_t>(info.st_size));
    std::size_t at = 0;
    while (at < bytes.size()) {
      const ssize_t got = ::pread(descriptor_, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return {};
      at += static_cast<std::size_t>(got);
    }
    return bytes;
  }

 private:
  int descriptor_;
};

void limit(int resource, std::size_t value) {
  const rlimit limits{value, value};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

// The sanitizer reserves more address space than any limit.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif

std::size_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void set_limits(const IsolationLimits& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  if constexpr (kLimitsMemory) limit(RLIMIT_AS, address_space() + limits.memory);
}

// Never returns: nothing of the parent's is to be run or written out a second time.
[[noreturn]] void run_child(const std::function<Bytes()>& work, const IsolationLimits& limits, const SharedFile& file) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, SIG_DFL);
  set_limits(limits);
  bool written = false;
  const auto fail = [&](const char* text) { written = file.write(&kFailure, 1) && file.write(text, std::strlen(text)); };
  try {
    const Bytes result = work();
    written = file.write(&kResult, 1) && file.write(result.data(), result.size());
  } catch (const std::bad_alloc&) {
    fail("reading it takes too much memory");
  } catch (const std::exception& e) {
    fail(e.what());
  } catch (...) {
    fail("the reader failed on it");
  }
  ::_exit(written ? 0 : 1);
}

}  // namespace

Bytes run_isolated(const std::function<Bytes()>& work, const IsolationLimits& limits) {
  const SharedFile file;
  const pid_t child = ::fork();
  if (child < 0) throw Error("cannot start a process: {}", std::strerror(errno));
  if (child == 0) run_child(work, limits, file);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    throw Error("reading it takes more than {} s", limits.seconds);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error("the reader crashed on it");
  Bytes bytes = file.content();
  if (bytes.empty()) throw Error("the reader crashed on it");
  const std::uint8_t kind = bytes.front();
  bytes.erase(bytes.begin());
  if (kind == kFailure) throw Error("{}", text_of(bytes));
  return bytes;
}

}  // namespace osteon::io
