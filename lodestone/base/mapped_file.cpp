#include "lodestone/base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace lodestone {

Result<MappedFile> map_file(const std::filesystem::path& path) {
  const auto failed = [&] {
    return fail(ErrorCode::cannot_read, std::generic_category().message(errno), path.string());
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return failed();
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) {
    ::close(descriptor);
    return failed();
  }
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size == 0) {
    ::close(descriptor);
    return MappedFile{};
  }
  void* const at = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  ::close(descriptor);
  if (at == MAP_FAILED) return failed();
  MappedFile out;
  out.mapping = std::shared_ptr<const void>(at, [size](const void* p) { ::munmap(const_cast<void*>(p), size); });
  out.bytes = {static_cast<const std::byte*>(at), size};
  return out;
}

}  // namespace lodestone
