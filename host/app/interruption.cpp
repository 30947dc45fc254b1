#include "host/app/interruption.h"

#include <csignal>

namespace meridian::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void onSignal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void listenForInterruption() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
}

bool isInterrupted() {
  return interrupted != 0;
}

}  // namespace meridian::app
