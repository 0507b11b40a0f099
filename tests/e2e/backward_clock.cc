// SPDX-License-Identifier: Apache-2.0
// For LD_PRELOAD: the calendar's clock of the process is set back by two seconds once a second.
// Other clocks are as they are. It does not always run backwards, because libraries of others wait
// for it as they are loaded (UCX, which Debian 13's LibTorch loads, for a millisecond).
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock != CLOCK_REALTIME) return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  timespec up{};
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &up);
  *time = {2'000'000'000 - up.tv_sec, up.tv_nsec};
  return 0;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* copy) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (copy != nullptr) *copy = now.tv_sec;
  return now.tv_sec;
}
}
