#include "app/children/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LODESTONE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LODESTONE_SANITIZED 1
#endif
#endif

namespace lodestone::app {
namespace fs = std::filesystem;

ChildLimits limits_for(std::uint64_t file_bytes) {
  const std::uint64_t megabytes = file_bytes / 1'000'000;
  const std::uint64_t seconds = 30 + megabytes;
  return ChildLimits{(std::uint64_t{2} << 30) + 64 * file_bytes, seconds, std::chrono::seconds(2 * seconds)};
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = temporary_folder_pattern() + "XXXXXX";
  if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

std::string temporary_folder_pattern() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return ((error ? fs::path("/tmp") : folder) / fmt::format("lod-{}-", ::getpid())).string();
}

namespace {

// Between fork and exec: only what is safe there.
[[noreturn]] void become_child(const char* program, char* const* words, int report, const ChildLimits& limits,
                               pid_t parent) {
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
  const rlimit file{limits.memory_bytes, limits.memory_bytes};
  ::setrlimit(RLIMIT_FSIZE, &file);
#ifndef LODESTONE_SANITIZED  // sanitizers reserve terabytes of addresses
  const rlimit memory{limits.memory_bytes, limits.memory_bytes};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  ::execv(program, words);
  ::_exit(127);
}

// Collects the report until the child ends, kills it when it must stop.
ChildOutcome wait_for(pid_t child, int report, std::chrono::seconds wall, const Task& task) {
  constexpr std::size_t kMostSaid = std::size_t{1} << 26;  // the names and places of a hundred thousand slices
  ChildOutcome out;
  std::string said;
  const auto deadline = std::chrono::steady_clock::now() + wall;
  while (true) {
    pollfd wanted{report, POLLIN, 0};
    ::poll(&wanted, 1, 50);
    if (task.cancelled()) out.end = ChildOutcome::End::cancelled;
    if (std::chrono::steady_clock::now() > deadline) out.end = ChildOutcome::End::timed_out;
    if (out.end != ChildOutcome::End::exited) {
      ::kill(child, SIGKILL);
      break;
    }
    if (wanted.revents == 0) continue;
    char buffer[4096];
    const ssize_t got = ::read(report, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    if (said.size() < kMostSaid) said.append(buffer, static_cast<std::size_t>(got));
  }
  out.report = parse_child_report(said);
  while (::waitpid(child, &out.status, 0) < 0 && errno == EINTR) {
  }
  return out;
}

}  // namespace

Result<ChildOutcome> run_child(const fs::path& program, std::vector<std::string> words, const ChildLimits& limits,
                               const Task& task) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    return fail(ErrorCode::cannot_read, std::generic_category().message(errno), program.string());
  }
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_child(program.c_str(), argv.data(), ends[1], limits, parent);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return fail(ErrorCode::cannot_read, "no second process could be started", program.string());
  }
  ChildOutcome outcome = wait_for(child, ends[0], limits.wall, task);
  ::close(ends[0]);
  return outcome;
}

std::string ending_of(const ChildOutcome& outcome, const ChildLimits& limits) {
  const bool signalled = WIFSIGNALED(outcome.status);
  const int number = signalled ? WTERMSIG(outcome.status) : 0;
  if (outcome.end == ChildOutcome::End::timed_out || number == SIGXCPU || number == SIGKILL || number == SIGXFSZ) {
    return fmt::format("the reader of this format was stopped: it used more than {} s or too much memory",
                       limits.cpu_seconds);
  }
  if (signalled) return fmt::format("the reader of this format crashed (signal {})", number);
  return fmt::format("the reader of this format ended with code {}", WEXITSTATUS(outcome.status));
}

}  // namespace lodestone::app
