// Files that are whole or not there.
//
// Problem: a run may fail, be interrupted, or run out of disk; no half file may be left and no older file be lost.
// Method: outputs are written nameless or under a hidden name beside their place and renamed over it.
// 1. InputFile, read_file(): regular files only, as a device would never end and a pipe without a writer would block.
// 2. output_place(): where an output goes. Symbolic links are followed; directories and
//    write-protected files are refused.
// 3. OutputFile: buffered writing; errors are kept and told by commit(), which renames. Without commit() nothing is
//    left. Permissions of an older file are kept.
// 4. StagingFolder: outputs of several files. plan_moves() finds out what can be known before anything is moved,
//    bring_beside() brings new files beside places in other folders, put_in_place() keeps each older file under a
//    second name, and restore() puts these back where a move fails.
// Invariants: a name that led to a file leads to a whole one, old or new, at any time, where the file system knows
// second names of files. Files are moved in the order of their names. POSIX calls are used where std::filesystem has no
// equal (O_TMPFILE, link, permissions).
#include "lodestone/base/file.h"
#include "lodestone/base/text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace lodestone {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

// Writes everything; returns 0 or the error number.
int write_all(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(descriptor, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return 0;
}

tl::unexpected<Error> not_regular(const std::filesystem::path& path) {
  return fail(ErrorCode::cannot_read, "is not a regular file", path.string(), "copy it to a file first");
}

constexpr mode_t kPermissions = 0777;

// Of the file in this place; 0 where there is none.
mode_t permissions_at(const std::filesystem::path& place) {
  struct stat status {};
  return ::stat(place.c_str(), &status) == 0 ? status.st_mode & kPermissions : 0;
}

// What stands for an output until it is whole.
std::filesystem::path hidden_beside(const std::filesystem::path& place) {
  return place.parent_path() / fmt::format(".{}.{}.tmp", place.filename().string(), ::getpid());
}

tl::unexpected<Error> in_the_way(const std::filesystem::path& hidden, const std::filesystem::path& output) {
  return fail(ErrorCode::cannot_write, fmt::format("{} is in the way, left by a run that was killed", hidden.string()),
              output.string(), "remove it");
}

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  // O_NONBLOCK: a pipe without a writer would block here. With a regular file it only means not to wait until another
  // program gives up a lease on it.
  int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && errno == EWOULDBLOCK) descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    const int error_number = errno;
    if (error_number == ENXIO) return not_regular(path);  // a socket
    return fail(ErrorCode::cannot_read, error_number == ENOENT ? "no such file" : reason(error_number), path.string(),
                error_number == ENOENT ? "is the name spelt right?" : "");
  }
  InputFile file;
  file.descriptor_ = descriptor;
  file.path_ = path;
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return fail(ErrorCode::cannot_read, reason(errno), path.string());
  if (S_ISDIR(status.st_mode)) {
    return fail(ErrorCode::cannot_read, "is a directory", path.string(), "name a file in it");
  }
  if (!S_ISREG(status.st_mode)) return not_regular(path);  // it may never end
  file.size_ = static_cast<std::uint64_t>(status.st_size);
  return file;
}

InputFile::InputFile(InputFile&& other) noexcept { *this = std::move(other); }

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  if (this != &other) {
    if (descriptor_ >= 0) ::close(descriptor_);
    path_ = std::move(other.path_);
    descriptor_ = std::exchange(other.descriptor_, -1);
    size_ = other.size_;
    position_ = other.position_;
  }
  return *this;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<std::size_t> InputFile::read(std::span<std::byte> into) {
  std::size_t got = 0;
  while (got < into.size()) {
    const ssize_t n = ::read(descriptor_, into.data() + got, into.size() - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return fail(ErrorCode::cannot_read, reason(errno), path_.string());
    if (n == 0) break;
    got += static_cast<std::size_t>(n);
  }
  position_ += got;
  return got;
}

Result<void> InputFile::seek(std::uint64_t offset) {
  if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) {
    return fail(ErrorCode::cannot_read, reason(errno), path_.string());
  }
  position_ = offset;
  return {};
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error) && !error;
}

std::string extension_of(const std::filesystem::path& path) { return lower_case(path.extension().string()); }

Result<std::string> read_file(const std::filesystem::path& path) {
  Result<InputFile> file = InputFile::open(path);
  LODESTONE_TRY(file);
  std::string bytes;
  std::size_t want = static_cast<std::size_t>(file->size()) + 1;  // one more, so that the end shows in one read
  while (true) {
    const std::size_t old = bytes.size();
    bytes.resize(old + want);
    const Result<std::size_t> got = file->read(std::as_writable_bytes(std::span(bytes).subspan(old)));
    LODESTONE_TRY(got);
    bytes.resize(old + *got);
    if (*got < want) return bytes;
    want = kBufferBytes;
  }
}

Result<std::filesystem::path> output_place(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  fs::path place = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(place, error)); ++links) {
    if (links == kMostLinks) {
      return fail(ErrorCode::cannot_write, "is a symbolic link that leads in a circle", path.string(), "remove it");
    }
    const fs::path target = fs::read_symlink(place, error);
    if (error) return fail(ErrorCode::cannot_write, error.message(), place.string());
    place = place.parent_path() / target;
  }
  const bool linked = place != path;
  const auto cannot = [&](const std::string& what, const std::string& remedy) {
    return fail(ErrorCode::cannot_write, linked ? fmt::format("leads to {}, which {}", place.string(), what) : what,
                path.string(), remedy);
  };
  const fs::file_status status = fs::status(place, error);
  if (place.filename().empty() || fs::is_directory(status)) return cannot("is a directory", "name a file in it");
  if (!fs::exists(status)) {
    const fs::path folder = place.parent_path().empty() ? "." : place.parent_path();
    if (linked && !fs::is_directory(folder, error)) return cannot("is in no existing folder", "make the folder first");
    return place;
  }
  if (!fs::is_regular_file(status)) return cannot("is not a regular file", "choose another name");
  constexpr fs::perms kWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if ((status.permissions() & kWrite) == fs::perms::none || ::access(place.c_str(), W_OK) != 0) {
    return cannot("is write-protected", "choose another name, or allow writing to it (chmod u+w)");
  }
  return place;
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  const Result<std::filesystem::path> place = output_place(path);
  LODESTONE_TRY(place);
  const std::filesystem::path folder = place->has_parent_path() ? place->parent_path() : ".";
  OutputFile file;
  file.path_ = path;
  file.place_ = *place;
#ifdef O_TMPFILE
  file.descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#endif
  if (file.descriptor_ < 0) {  // no nameless files here: a hidden one, removed unless committed
    file.hidden_ = hidden_beside(*place);
    file.descriptor_ = ::open(file.hidden_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  }
  if (file.descriptor_ < 0) {
    const int error_number = errno;
    const std::filesystem::path hidden = std::exchange(file.hidden_, {});
    if (error_number == EEXIST) return in_the_way(hidden, path);
    return fail(ErrorCode::cannot_write, error_number == ENOENT ? "its folder does not exist" : reason(error_number),
                path.string(), error_number == ENOENT ? "make the folder first" : "");
  }
  if (const mode_t old = permissions_at(*place); old != 0 && ::fchmod(file.descriptor_, old) != 0) {
    return fail(ErrorCode::cannot_write, "its permissions cannot be kept: " + reason(errno), path.string(),
                "choose another name");
  }
  file.buffer_.reserve(kBufferBytes);
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept { *this = std::move(other); }

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    place_ = std::move(other.place_);
    hidden_ = std::exchange(other.hidden_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
    error_number_ = other.error_number_;
    written_ = other.written_;
    buffer_ = std::move(other.buffer_);
  }
  return *this;
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!hidden_.empty()) ::unlink(hidden_.c_str());
}

void OutputFile::write(std::span<const std::byte> bytes) {
  write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void OutputFile::write(std::string_view text) {
  written_ += text.size();
  if (error_number_ != 0) return;
  if (buffer_.size() + text.size() > kBufferBytes) flush();
  if (text.size() >= kBufferBytes) {
    if (error_number_ == 0) error_number_ = write_all(descriptor_, text.data(), text.size());
  } else {
    buffer_.append(text);
  }
}

void OutputFile::flush() {
  if (error_number_ == 0) error_number_ = write_all(descriptor_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

Result<void> OutputFile::commit() {
  flush();
  const auto cannot = [&](int error_number) {
    return fail(ErrorCode::cannot_write, reason(error_number), path_.string(),
                error_number == ENOSPC ? "free some space; nothing was left behind" : "nothing was left behind");
  };
  if (error_number_ != 0) return cannot(error_number_);
  if (hidden_.empty()) {  // give the nameless file a name beside its place, then rename over the old one
    std::filesystem::path name = hidden_beside(place_);
    const std::string self = fmt::format("/proc/self/fd/{}", descriptor_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return errno == EEXIST ? in_the_way(name, path_) : cannot(errno);
    }
    hidden_ = std::move(name);
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) return cannot(errno);
  if (::rename(hidden_.c_str(), place_.c_str()) != 0) return cannot(errno);
  hidden_.clear();
  return {};
}

Result<StagingFolder> StagingFolder::create(const std::filesystem::path& output) {
  StagingFolder staging;
  staging.folder_ = output.parent_path();
  const std::filesystem::path hidden = hidden_beside(output);
  std::error_code error;
  if (!std::filesystem::create_directory(hidden, error)) {
    if (error) {
      return fail(ErrorCode::cannot_write, error.message(), output.string(),
                  "does its folder exist, and may you write there?");
    }
    return in_the_way(hidden, output);
  }
  staging.hidden_ = hidden;
  for (const char* inner : {"new", "old"}) {
    std::filesystem::create_directory(hidden / inner, error);
    if (error) return fail(ErrorCode::cannot_write, error.message(), output.string());
  }
  return staging;
}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      hidden_(std::exchange(other.hidden_, {})),
      elsewhere_(std::exchange(other.elsewhere_, {})),
      keep_hidden_(other.keep_hidden_) {}

StagingFolder::~StagingFolder() {
  if (hidden_.empty() || keep_hidden_) return;
  std::error_code ignored;
  elsewhere_.push_back(hidden_);
  for (const std::filesystem::path& folder : elsewhere_) std::filesystem::remove_all(folder, ignored);
}

Result<void> StagingFolder::commit() {
  Result<std::vector<Move>> moves = plan_moves();
  LODESTONE_TRY(moves);
  for (Move& move : *moves) {
    LODESTONE_TRY(bring_beside(move));
  }
  for (std::size_t i = 0; i < moves->size(); ++i) {
    const Move& move = (*moves)[i];
    const int error_number = put_in_place(move);
    if (error_number == 0) continue;
    for (std::size_t placed = i; placed-- > 0;) {
      if (!restore((*moves)[placed])) ::unlink((*moves)[placed].place.c_str());
    }
    return fail(ErrorCode::cannot_write, reason(error_number), move.place.string(),
                keep_hidden_ ? "older files are in " + move.aside.parent_path().string() : "nothing was changed");
  }
  return {};
}

// What can be known before anything is moved.
Result<std::vector<StagingFolder::Move>> StagingFolder::plan_moves() const {
  const std::filesystem::path folder = folder_.empty() ? "." : folder_;
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return fail(ErrorCode::cannot_write, reason(errno), folder.string(), "choose a folder that you may write to");
  }
  std::vector<std::filesystem::path> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path(), error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename());
  }
  if (error) return fail(ErrorCode::cannot_write, error.message(), hidden_.string());
  std::sort(names.begin(), names.end());  // the same order everywhere
  std::vector<Move> moves;
  for (const std::filesystem::path& name : names) {
    const Result<std::filesystem::path> place = output_place(folder_ / name);
    LODESTONE_TRY(place);
    const bool is_file = std::filesystem::is_regular_file(path() / name, error);
    const mode_t old = is_file ? permissions_at(*place) : 0;
    if (old != 0 && ::chmod((path() / name).c_str(), old) != 0) {
      return fail(ErrorCode::cannot_write, "its permissions cannot be kept: " + reason(errno), place->string());
    }
    moves.push_back({path() / name, *place, hidden_ / "old" / name});
  }
  return moves;
}

// A link may lead to another file system, where nothing can be renamed to: the new file is brought beside its place.
Result<void> StagingFolder::bring_beside(Move& move) {
  if (move.place.parent_path() == folder_) return {};
  const std::filesystem::path hidden = hidden_beside(move.place);
  std::error_code error;
  if (!std::filesystem::create_directory(hidden, error) && !error) {
    return fail(ErrorCode::cannot_write, fmt::format("{} is in the way", hidden.string()), move.place.string(),
                "remove it, unless two links lead to the same file");
  }
  if (!error) {
    elsewhere_.push_back(hidden);
    std::filesystem::rename(move.fresh, hidden / "new", error);
    if (error) std::filesystem::copy_file(move.fresh, hidden / "new", error);
  }
  if (error) return fail(ErrorCode::cannot_write, error.message(), move.place.string(), "nothing was changed");
  move.fresh = hidden / "new";
  move.aside = hidden / "old";
  return {};
}

// Returns 0 or the error number; then the older file, if there is one, is still or again in its place.
int StagingFolder::put_in_place(const Move& move) {
  // A second name for the older file, so that the first leads to a whole file at any time; where the file system has no
  // second names, it is moved.
  const bool kept = ::link(move.place.c_str(), move.aside.c_str()) == 0 || errno == ENOENT ||
                    ::rename(move.place.c_str(), move.aside.c_str()) == 0 || errno == ENOENT;
  if (!kept) return errno;
  if (::rename(move.fresh.c_str(), move.place.c_str()) == 0) return 0;
  const int error_number = errno;
  restore(move);
  return error_number;
}

// Puts the older file back into its place; false if there was none.
bool StagingFolder::restore(const Move& move) {
  if (::rename(move.aside.c_str(), move.place.c_str()) == 0) return true;
  if (errno == ENOENT) return false;
  keep_hidden_ = true;  // better a hidden folder that stays than an older file that is lost
  return true;
}

}  // namespace lodestone
