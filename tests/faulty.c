/* Fault injection. Linked into the programs `delbm-faulty` and `host-faulty`, this file replaces functions of the C
 * library for the program and for its libraries. DELBM_FAIL="memory 17" makes the 17th allocation after the start of
 * main fail; likewise `thread`, `file` and the name of a function, "lseek 2"; with "memory 17 on" also all later
 * allocations, and with "memory 17 kill" the process is killed in place of the call. A call that is made to fail is named in the file DELBM_FAILED_AT. DELBM_LOCALE sets the locale of the
 * process. The installed delbm contains none of this. */
#include "faulty.h"

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum kind { KIND_NONE, KIND_MEMORY, KIND_THREAD, KIND_FILE };

static enum kind chosen;
static char chosen_name[16];
static long chosen_call;
static bool lasting, killing;
static atomic_long calls;
static int report = -1;

/* The C library's function of this name. */
#define ORIGINAL(name)                                                                                                 \
  static __typeof__(&name) original;                                                                                   \
  if (!original) *(void **)&original = dlsym(RTLD_NEXT, #name);

static bool is_to_fail(enum kind kind, const char *name)
{
  if (kind != chosen && strcmp(name, chosen_name) != 0) return false;
  const long call = atomic_fetch_add(&calls, 1) + 1;
  if (call < chosen_call || (call > chosen_call && !lasting)) return false;
  if (call == chosen_call && report >= 0) dprintf(report, "%s\n", name);
  if (killing) raise(SIGKILL);
  return true;
}

/* HDF5 can crash or shut down on a failed allocation within itself or within a library that it calls. Such
 * allocations never fail: on the call stack, from the caller outwards, HDF5 comes before delbm. Not inlined, since
 * sanitizers call malloc at their start, before they can instrument variables on the stack. */
static __attribute__((noinline)) bool is_of_hdf5(const void *caller)
{
  static _Thread_local bool looking;
  static char ours;
  void *frame[24];
  Dl_info self, at;
  if (looking) return true; /* allocations of the search itself */
  looking = true;
  const int count = backtrace(frame, sizeof frame / sizeof frame[0]);
  int k = 0;
  while (k < count && frame[k] != caller) k++;
  bool found = false, known = dladdr(&ours, &self) != 0;
  for (; k < count && known && !found; k++) {
    if (!dladdr(frame[k], &at)) continue;
    known = at.dli_fbase != self.dli_fbase;
    found = strstr(at.dli_fname, "hdf5") != NULL;
  }
  looking = false;
  return found;
}

static bool is_memory_to_fail(const char *name, const void *caller)
{
  return chosen == KIND_MEMORY && !is_of_hdf5(caller) && is_to_fail(KIND_MEMORY, name);
}

void faulty_begin(const char *wish)
{
  static const char *const names[] = {"none", "memory", "thread", "file"};
  char then[5] = "", name[sizeof chosen_name];
  long call = 0;
  if (sscanf(wish, "%15s %ld %4s", name, &call, then) < 2) return;
  memcpy(chosen_name, name, sizeof chosen_name);
  chosen_call = call;
  atomic_store(&calls, 0);
  lasting = strcmp(then, "on") == 0;
  killing = strcmp(then, "kill") == 0;
  for (int kind = KIND_MEMORY; kind <= KIND_FILE; kind++)
    if (strcmp(chosen_name, names[kind]) == 0) chosen = (enum kind)kind;
}

bool faulty_end(void)
{
  chosen = KIND_NONE;
  chosen_name[0] = '\0';
  return atomic_load(&calls) >= chosen_call;
}

/* Runs after the constructors of the libraries, so that their calls are not counted. */
static __attribute__((constructor)) void arm(void)
{
  const char *wish = getenv("DELBM_FAIL"), *path = getenv("DELBM_FAILED_AT");
  if (!wish) return;
  if (path) report = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  faulty_begin(wish);
}

static __attribute__((constructor)) void set_locale(void)
{
  const char *name = getenv("DELBM_LOCALE");
  if (name && !setlocale(LC_ALL, name)) abort();
}

static void *no_memory(void)
{
  errno = ENOMEM;
  return NULL;
}

static int no_room(void)
{
  errno = ENOSPC;
  return -1;
}

void *malloc(size_t size)
{
  ORIGINAL(malloc)
  return is_memory_to_fail("malloc", __builtin_return_address(0)) ? no_memory() : original(size);
}

void *calloc(size_t count, size_t size)
{
  ORIGINAL(calloc)
  return is_memory_to_fail("calloc", __builtin_return_address(0)) ? no_memory() : original(count, size);
}

void *realloc(void *pointer, size_t size)
{
  ORIGINAL(realloc)
  return is_memory_to_fail("realloc", __builtin_return_address(0)) ? no_memory() : original(pointer, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
  ORIGINAL(aligned_alloc)
  return is_memory_to_fail("aligned_alloc", __builtin_return_address(0)) ? no_memory() : original(alignment, size);
}

void *mmap(void *address, size_t length, int protection, int flags, int descriptor, off_t offset)
{
  ORIGINAL(mmap)
  if (!is_memory_to_fail("mmap", __builtin_return_address(0)))
    return original(address, length, protection, flags, descriptor, offset);
  errno = ENOMEM;
  return MAP_FAILED;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
  ORIGINAL(pthread_create)
  return is_to_fail(KIND_THREAD, "pthread_create") ? EAGAIN : original(thread, attributes, start, argument);
}

int open(const char *path, int flags, ...)
{
  ORIGINAL(open)
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return is_to_fail(KIND_FILE, "open") ? no_room() : original(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
  ORIGINAL(openat)
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return is_to_fail(KIND_FILE, "openat") ? no_room() : original(folder, path, flags, mode);
}

FILE *fopen(const char *restrict path, const char *restrict mode)
{
  ORIGINAL(fopen)
  if (!is_to_fail(KIND_FILE, "fopen")) return original(path, mode);
  errno = ENOSPC;
  return NULL;
}

DIR *opendir(const char *path)
{
  ORIGINAL(opendir)
  if (!is_to_fail(KIND_FILE, "opendir")) return original(path);
  errno = EIO;
  return NULL;
}

/* A failed write sets the error flag of the stream. */
size_t fwrite(const void *restrict data, size_t size, size_t count, FILE *restrict stream)
{
  ORIGINAL(fwrite)
  if (!is_to_fail(KIND_FILE, "fwrite")) return original(data, size, count, stream);
  errno = ENOSPC;
  stream->_flags |= 0x20; /* glibc's mark of an error */
  return 0;
}

size_t fread(void *restrict data, size_t size, size_t count, FILE *restrict stream)
{
  ORIGINAL(fread)
  if (!is_to_fail(KIND_FILE, "fread")) return original(data, size, count, stream);
  errno = EIO;
  stream->_flags |= 0x20;
  return 0;
}

int fflush(FILE *stream)
{
  ORIGINAL(fflush)
  return is_to_fail(KIND_FILE, "fflush") ? no_room() : original(stream);
}

/* A close that fails closes the stream nevertheless. */
int fclose(FILE *stream)
{
  ORIGINAL(fclose)
  const bool fails = is_to_fail(KIND_FILE, "fclose");
  const int closed = original(stream);
  return fails ? no_room() : closed;
}

int close(int descriptor)
{
  ORIGINAL(close)
  const bool fails = is_to_fail(KIND_FILE, "close");
  const int closed = original(descriptor);
  return fails ? no_room() : closed;
}

ssize_t write(int descriptor, const void *data, size_t size)
{
  ORIGINAL(write)
  return is_to_fail(KIND_FILE, "write") ? no_room() : original(descriptor, data, size);
}

int mkdir(const char *path, mode_t mode)
{
  ORIGINAL(mkdir)
  return is_to_fail(KIND_FILE, "mkdir") ? no_room() : original(path, mode);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
  ORIGINAL(renameat)
  return is_to_fail(KIND_FILE, "renameat") ? no_room() : original(from_folder, from, to_folder, to);
}

int unlink(const char *path)
{
  ORIGINAL(unlink)
  return is_to_fail(KIND_FILE, "unlink") ? no_room() : original(path);
}

int rmdir(const char *path)
{
  ORIGINAL(rmdir)
  return is_to_fail(KIND_FILE, "rmdir") ? no_room() : original(path);
}

int fsync(int descriptor)
{
  ORIGINAL(fsync)
  return is_to_fail(KIND_FILE, "fsync") ? no_room() : original(descriptor);
}

int ftruncate(int descriptor, off_t length)
{
  ORIGINAL(ftruncate)
  return is_to_fail(KIND_FILE, "ftruncate") ? no_room() : original(descriptor, length);
}

ssize_t pwrite(int descriptor, const void *data, size_t size, off_t at)
{
  ORIGINAL(pwrite)
  return is_to_fail(KIND_FILE, "pwrite") ? no_room() : original(descriptor, data, size, at);
}

ssize_t pread(int descriptor, void *data, size_t size, off_t at)
{
  ORIGINAL(pread)
  return is_to_fail(KIND_FILE, "pread") ? no_room() : original(descriptor, data, size, at);
}

off_t lseek(int descriptor, off_t offset, int whence)
{
  ORIGINAL(lseek)
  return is_to_fail(KIND_FILE, "lseek") ? no_room() : original(descriptor, offset, whence);
}
