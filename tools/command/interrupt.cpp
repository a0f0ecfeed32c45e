#include "interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <thread>

#include "plumb/data/io/staged_folder.hpp"

namespace plumb::command {

void remove_staging_when_interrupted() {
  static const bool once = [] {
    sigset_t signals;
    sigemptyset(&signals);
    // Blocked, SIGPIPE and SIGXFSZ of a write of ours do not reach the thread below, but the write
    // fails.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ, SIGXCPU, SIGALRM,
                             SIGVTALRM, SIGPROF, SIGUSR1, SIGUSR2}) {
      struct sigaction now;
      sigaction(signal, nullptr, &now);
      if (now.sa_handler != SIG_IGN) sigaddset(&signals, signal);  // nohup stays in force
    }
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals] {
      int signal = 0;
      while (sigwait(&signals, &signal) != 0) {
      }
      io::remove_all_staging();
      std::fputs("\nplumb: interrupted; what was unfinished is removed\n", stderr);
      _exit(128 + signal);
    }).detach();
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace plumb::command
