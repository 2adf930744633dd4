#include "app/foreign.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <system_error>

#include "lodestone/base/file.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LODESTONE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LODESTONE_SANITIZED 1
#endif
#endif

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

constexpr int kReportDescriptor = 3;
constexpr const char* kConvertFirst = "convert it to glTF, OBJ or PLY with the program that made it";

// A file of a few kilobytes may not cost more than these; larger ones get more in proportion.
struct Limits {
  rlim_t memory_bytes;
  rlim_t cpu_seconds;
  std::chrono::seconds wall;
};

Limits limits_for(std::uint64_t file_bytes) {
  const std::uint64_t megabytes = file_bytes / 1'000'000;
  const std::uint64_t seconds = 30 + megabytes;
  return Limits{(std::uint64_t{2} << 30) + 64 * file_bytes, seconds, std::chrono::seconds(2 * seconds)};
}

// A private folder that goes with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = temporary_folder_pattern() + "XXXXXX";
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Between fork and exec: only what is safe there.
[[noreturn]] void become_reader(char* const* words, int report, const Limits& limits, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, 0);
  ::dup2(nowhere, 1);
  ::dup2(nowhere, 2);
  if (report == kReportDescriptor) {
    ::fcntl(report, F_SETFD, 0);
  } else {
    ::dup2(report, kReportDescriptor);
  }
  // Ctrl-C in a terminal reaches the child too; the parent decides.
  std::signal(SIGINT, SIG_IGN);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const rlimit cpu{limits.cpu_seconds, limits.cpu_seconds + 1};
  ::setrlimit(RLIMIT_CPU, &cpu);
#ifndef LODESTONE_SANITIZED  // sanitizers reserve terabytes of addresses
  const rlimit memory{limits.memory_bytes, limits.memory_bytes};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  ::execv("/proc/self/exe", words);
  ::_exit(127);
}

struct Outcome {
  std::string report;  // what the child said
  int status = 0;
  enum class End { exited, timed_out, cancelled } end = End::exited;
};

// Collects the report until the child ends, kills it when it must stop.
Outcome wait_for(pid_t child, int report, std::chrono::seconds wall, const Task& task) {
  Outcome out;
  const auto deadline = std::chrono::steady_clock::now() + wall;
  while (true) {
    pollfd wanted{report, POLLIN, 0};
    ::poll(&wanted, 1, 50);
    if (task.cancelled()) out.end = Outcome::End::cancelled;
    if (std::chrono::steady_clock::now() > deadline) out.end = Outcome::End::timed_out;
    if (out.end != Outcome::End::exited) {
      ::kill(child, SIGKILL);
      break;
    }
    if (wanted.revents == 0) continue;
    char buffer[4096];
    const ssize_t got = ::read(report, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    if (out.report.size() < (std::size_t{1} << 20)) out.report.append(buffer, static_cast<std::size_t>(got));
  }
  while (::waitpid(child, &out.status, 0) < 0 && errno == EINTR) {
  }
  return out;
}

// One "key value" a line.
void tell(std::string_view key, std::string value) {
  for (char& c : value) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  const std::string line = fmt::format("{} {}\n", key, value);
  if (::write(kReportDescriptor, line.data(), line.size()) < 0) std::_Exit(1);
}

struct ChildReport {
  bool done = false, failed = false;
  double meters_per_unit = 0;
  std::uint64_t vertices = 0, triangles = 0;
  std::vector<std::string> warnings;
  Error error;
};

ChildReport parse_report(const std::string& text) {
  ChildReport report;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string key = line.substr(0, space);
    const std::string value = line.substr(std::min(space + 1, line.size()));
    if (key == "unit") report.meters_per_unit = std::strtod(value.c_str(), nullptr);
    if (key == "vertices") report.vertices = std::strtoull(value.c_str(), nullptr, 10);
    if (key == "triangles") report.triangles = std::strtoull(value.c_str(), nullptr, 10);
    if (key == "warning") report.warnings.push_back(value);
    if (key == "code") report.error.code = static_cast<ErrorCode>(std::atoi(value.c_str()));
    if (key == "what") report.error.what = value;
    if (key == "where") report.error.where = value;
    if (key == "remedy") report.error.remedy = value;
    if (key == "done") report.done = true;
    if (key == "failed") report.failed = true;
  }
  return report;
}

// Why a child that did not finish its report ended.
tl::unexpected<Error> reader_failed(const fs::path& path, const Outcome& outcome, const Limits& limits) {
  const bool signalled = WIFSIGNALED(outcome.status);
  const int number = signalled ? WTERMSIG(outcome.status) : 0;
  std::string what;
  if (outcome.end == Outcome::End::timed_out || number == SIGXCPU || number == SIGKILL) {
    what = fmt::format("the reader of this format was stopped: it used more than {} s or too much memory",
                       limits.cpu_seconds);
  } else if (signalled) {
    what = fmt::format("the reader of this format crashed (signal {})", number);
  } else {
    what = fmt::format("the reader of this format ended with code {}", WEXITSTATUS(outcome.status));
  }
  return fail(ErrorCode::bad_format, what, path.string(), kConvertFirst);
}

Result<Outcome> run_reader(const fs::path& path, const fs::path& glb, const Limits& limits, const Task& task) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    return fail(ErrorCode::cannot_read, std::generic_category().message(errno), path.string());
  }
  std::string words[] = {"lod", kForeignVerb, path.string(), glb.string()};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_reader(argv, ends[1], limits, parent);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return fail(ErrorCode::cannot_read, "no second process could be started", path.string());
  }
  Outcome outcome = wait_for(child, ends[0], limits.wall, task);
  ::close(ends[0]);
  return outcome;
}

}  // namespace

std::string temporary_folder_pattern() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return ((error ? fs::path("/tmp") : folder) / fmt::format("lod-{}-", ::getpid())).string();
}

Result<Model> read_foreign(const fs::path& path, Task task) {
  const Result<InputFile> file = InputFile::open(path);
  if (!file) return fail(file.error());
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return fail(ErrorCode::cannot_write, "no temporary folder could be made", path.string(), "set TMPDIR to one");
  }
  const fs::path glb = folder.path() / "model.glb";
  const Limits limits = limits_for(file->size());
  const Result<Outcome> outcome = run_reader(path, glb, limits, task);
  if (!outcome) return fail(outcome.error());
  if (outcome->end == Outcome::End::cancelled) return cancelled_error("reading");
  ChildReport report = parse_report(outcome->report);
  if (report.failed) return fail(std::move(report.error));
  if (!report.done || outcome->status != 0) return reader_failed(path, *outcome, limits);

  Result<Model> model = io::read_model(glb, {}, task);
  if (!model) return model;
  model->files = {path};
  model->meters_per_unit = report.meters_per_unit;
  model->file_vertices = report.vertices;
  model->file_triangles = report.triangles;
  model->warnings = std::move(report.warnings);
  return model;
}

int foreign_main(const std::vector<std::string>& words) {
  if (words.size() != 2 || ::fcntl(kReportDescriptor, F_GETFD) < 0) return 2;
  Error error;
  try {
    const Result<Model> model = io::read_model(words[0]);
    const Result<io::WriteReport> written =
        model ? io::write_model(*model, words[1]) : Result<io::WriteReport>(fail(model.error()));
    if (written) {
      tell("unit", fmt::format("{}", model->meters_per_unit));
      tell("vertices", fmt::format("{}", model->file_vertices));
      tell("triangles", fmt::format("{}", model->file_triangles));
      for (const std::string& warning : model->warnings) tell("warning", warning);
      tell("done", "");
      return 0;
    }
    error = written.error();
  } catch (const std::bad_alloc&) {
    error = Error{ErrorCode::out_of_memory, "reading it needs more memory than it may take", words[0], kConvertFirst};
  }
  tell("code", fmt::format("{}", static_cast<int>(error.code)));
  tell("what", error.what);
  tell("where", error.where);
  tell("remedy", error.remedy);
  tell("failed", "");
  return 1;
}

}  // namespace lodestone::app
