#include "app/interrupt.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string>

#include "app/children/child_process.h"
#include "app/output/terminal.h"
#include "app/output/text.h"
#include "lodestone/base/check.h"

namespace lodestone::app {
namespace {

// Set before any handler is installed, never freed: a handler may run at any time, on any thread.
const Task* g_root = nullptr;
const std::string* g_warning = nullptr;
std::atomic<int> g_signals{0};
static_assert(std::atomic<int>::is_always_lock_free, "a handler must not wait for a lock");

extern "C" void on_signal(int signal_number) {
  const int saved = errno;
  const int count = ++g_signals;
  if (count == 1) g_root->cancel();
  if (count == 2) {
    [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, g_warning->data(), g_warning->size());
  }
  if (count >= 3) {
    std::signal(signal_number, SIG_DFL);
    ::raise(signal_number);  // blocked until the handler returns
  }
  errno = saved;
}

// A handler can't make text, so it is made beforehand. Names of temporary files hold the process id (base/file.cpp).
std::string warning_text() {
  const char* clear_bar = error_terminal() == Terminal::full    ? "\r\033[K"
                          : error_terminal() == Terminal::plain ? "\r"
                                                                : "";
  const std::string left = fmt::format(".*.{}.tmp beside the output, {}*", ::getpid(), temporary_folder_pattern());
  return fmt::format("{}lod: stopping; a third signal ends it at once and may leave temporary files: {}\n", clear_bar,
                     printable(left));
}

}  // namespace

void cancel_on_signals(const Task& root) {
  LODESTONE_CHECK(g_root == nullptr, "called once");
  g_root = new Task(root);
  g_warning = new std::string(warning_text());
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, signal_number);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal_number, nullptr, &before);
    if (before.sa_handler != SIG_IGN || signal_number != SIGHUP) sigaction(signal_number, &action, nullptr);  // nohup
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace lodestone::app
