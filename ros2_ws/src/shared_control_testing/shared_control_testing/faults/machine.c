// Copyright 2026 shared-control maintainers
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

/* Preloaded into the processes of a session (see machine.py): sets their clock, and loses, repeats, delays and garbles
   the packets that they send, as a file says that all of them have mapped. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

struct plan {
  _Atomic int64_t clock_ns;
  _Atomic uint32_t drop, duplicate, reorder, corrupt; /* of 1000 packets */
};

static struct plan none;
static struct plan *plan = &none;

__attribute__((constructor)) static void map_plan(void) {
  const char *path = getenv("SHARED_CONTROL_FAULTS");
  int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  void *mapped = file < 0 ? MAP_FAILED : mmap(NULL, sizeof *plan, PROT_READ, MAP_SHARED, file, 0);
  if (mapped != MAP_FAILED) plan = mapped;
  if (file >= 0) close(file);
}

#define REAL(name) \
  static __typeof__(&name) real; \
  if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

/* -- clock ------------------------------------------------------------------------------------------------------- */

static void shift(struct timespec *at, int64_t by_ns) {
  int64_t ns = at->tv_sec * INT64_C(1000000000) + at->tv_nsec + by_ns;
  at->tv_sec = ns / 1000000000;
  at->tv_nsec = ns % 1000000000;
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  REAL(clock_gettime);
  int failed = real(clock, now);
  if (!failed && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) shift(now, atomic_load(&plan->clock_ns));
  return failed;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  (void)zone;
  struct timespec exact;
  clock_gettime(CLOCK_REALTIME, &exact);
  now->tv_sec = exact.tv_sec;
  now->tv_usec = exact.tv_nsec / 1000;
  return 0;
}

time_t time(time_t *now) {
  struct timespec exact;
  clock_gettime(CLOCK_REALTIME, &exact);
  if (now) *now = exact.tv_sec;
  return exact.tv_sec;
}

/* Who waits until a time of the day waits in the kernel, whose clock nobody has set. */
int pthread_cond_timedwait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex,
                           const struct timespec *restrict until) {
  static __typeof__(&pthread_cond_timedwait) real;
  if (!real) real = (__typeof__(real))dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2"); /* x86-64 has an older one */
  if (!real) real = (__typeof__(real))dlsym(RTLD_NEXT, "pthread_cond_timedwait");
  struct timespec at = *until;
  if (at.tv_sec > 1000000000) shift(&at, -atomic_load(&plan->clock_ns)); /* no computer is up for 31 years */
  return real(condition, mutex, &at);
}

/* -- network ------------------------------------------------------------------------------------------------------ */

enum { LARGEST = 65536, HEADER = 44 }; /* of RTPS: 20 bytes, and the beginning of what follows */

static _Thread_local uint64_t state;

static uint32_t draw(uint32_t below) {
  if (!state) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    state = (uint64_t)now.tv_nsec * 2654435761u + (uint64_t)getpid() + 1;
  }
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (uint32_t)(state >> 33) % below;
}

static struct {
  pthread_mutex_t mutex;
  int socket;
  size_t size;
  socklen_t address_size;
  struct sockaddr_storage address;
  unsigned char data[LARGEST];
} held = {.mutex = PTHREAD_MUTEX_INITIALIZER};

static ssize_t send_one(int socket, const void *data, size_t size, const void *address, socklen_t address_size, int flags) {
  REAL(sendto);
  return real(socket, data, size, flags, address, address_size);
}

/* The packet goes out after the next one. */
static int hold(int socket, const void *data, size_t size, const void *address, socklen_t address_size) {
  int is_held = 0;
  pthread_mutex_lock(&held.mutex);
  if (!held.size && size <= LARGEST) {
    held.socket = socket;
    held.size = size;
    held.address_size = address_size;
    memcpy(&held.address, address, address_size);
    memcpy(held.data, data, size);
    is_held = 1;
  }
  pthread_mutex_unlock(&held.mutex);
  return is_held;
}

static void let_go(void) {
  if (!held.size) return;
  pthread_mutex_lock(&held.mutex);
  if (held.size)
    send_one(held.socket, held.data, held.size, &held.address, held.address_size, MSG_DONTWAIT);
  held.size = 0;
  pthread_mutex_unlock(&held.mutex);
}

static ssize_t disturbed(int socket, const void *data, size_t size, const void *address, socklen_t address_size, int flags) {
  if (draw(1000) < atomic_load(&plan->drop)) return (ssize_t)size;
  if (draw(1000) < atomic_load(&plan->reorder) && hold(socket, data, size, address, address_size)) return (ssize_t)size;
  if (draw(1000) < atomic_load(&plan->corrupt)) {
    unsigned char garbled[LARGEST];
    if (size <= LARGEST) {
      memcpy(garbled, data, size);
      garbled[draw(size < HEADER ? (uint32_t)size : HEADER)] ^= (unsigned char)(1 + draw(255));
      send_one(socket, garbled, draw(4) ? size : draw((uint32_t)size) + 1, address, address_size, flags);
    }
    return (ssize_t)size;
  }
  ssize_t sent = send_one(socket, data, size, address, address_size, flags);
  if (draw(1000) < atomic_load(&plan->duplicate)) send_one(socket, data, size, address, address_size, flags);
  let_go();
  return sent;
}

static int is_disturbed(const void *address, socklen_t size) {
  uint32_t any = atomic_load(&plan->drop) | atomic_load(&plan->duplicate) | atomic_load(&plan->reorder) |
                 atomic_load(&plan->corrupt);
  return any && address && size >= sizeof(struct sockaddr_in) &&
         ((const struct sockaddr *)address)->sa_family == AF_INET;
}

ssize_t sendto(int socket, const void *data, size_t size, int flags, const struct sockaddr *address, socklen_t address_size) {
  return size && is_disturbed(address, address_size) ? disturbed(socket, data, size, address, address_size, flags)
                                                     : send_one(socket, data, size, address, address_size, flags);
}

ssize_t sendmsg(int socket, const struct msghdr *message, int flags) {
  REAL(sendmsg);
  unsigned char data[LARGEST];
  size_t size = 0;
  if (!is_disturbed(message->msg_name, message->msg_namelen)) return real(socket, message, flags);
  for (size_t i = 0; i < message->msg_iovlen; i++) {
    if (size + message->msg_iov[i].iov_len > sizeof data) return real(socket, message, flags);
    memcpy(data + size, message->msg_iov[i].iov_base, message->msg_iov[i].iov_len);
    size += message->msg_iov[i].iov_len;
  }
  return size ? disturbed(socket, data, size, message->msg_name, message->msg_namelen, flags) : real(socket, message, flags);
}
