#include "app/interrupt.h"

#include <csignal>

#include "lodestone/base/check.h"

namespace lodestone::app {
namespace {

const Task* g_root = nullptr;  // set before any handler is installed, never freed: a handler may run at any time

extern "C" void on_signal(int signal_number) {
  g_root->cancel();
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

void cancel_on_signals(const Task& root) {
  LODESTONE_CHECK(g_root == nullptr, "called once");
  g_root = new Task(root);
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal_number, nullptr, &before);
    if (before.sa_handler != SIG_IGN || signal_number != SIGHUP) sigaction(signal_number, &action, nullptr);  // nohup
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace lodestone::app
