#include "base/memory.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

static const size_t huge_page = (size_t)2 << 20;

double memory_physical(void)
{
  return (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
}

double memory_resident(void)
{
  FILE *file = fopen("/proc/self/statm", "re"); /* "SIZE RESIDENT ...", in pages */
  char line[128] = "";
  if (!file) return 0;
  const char *second = fgets(line, sizeof line, file) ? strchr(line, ' ') : NULL;
  const long pages = second ? strtol(second, NULL, 10) : 0;
  fclose(file);
  return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

static const double gib = 1 << 30;

/* The only variable shared by the functions below; atomic, since threads allocate concurrently. */
static _Atomic size_t handed_out;

double memory_handed_out(void)
{
  return (double)handed_out;
}

static bool out_of_memory(const char *what, double bytes, struct status *status)
{
  status_fail(status, DELBM_FAILED, "out of memory: %.3g GiB for %s", bytes / gib, what);
  status->out_of_memory = true;
  return false;
}

/* Fails as an invalid case: the machine is too small. */
static bool is_within_budget(const char *what, double bytes, struct status *status)
{
  const double resident = bytes < (double)huge_page ? 0 : memory_resident(), physical = memory_physical();
  if (resident + bytes <= physical) return true;
  status_fail(status, DELBM_INVALID, "too large for this machine: %.3g GiB for %s beside %.3g GiB in use, of %.3g GiB",
              bytes / gib, what, resident / gib, physical / gib);
  status->out_of_memory = true;
  return false;
}

static size_t round_up(size_t n, size_t to)
{
  return (n + to - 1) / to * to;
}

void *memory_allocate(size_t count, size_t size, const char *what, struct status *status)
{
  const double wanted = (double)count * (double)size;
  if (!is_within_budget(what, wanted, status)) return NULL;
  const size_t alignment = count * size < huge_page ? CACHE_LINE : huge_page;
  const size_t bytes = wanted > 0 ? round_up(count * size, alignment) : CACHE_LINE;
  void *pointer = aligned_alloc(alignment, bytes);
  if (!pointer) {
    out_of_memory(what, wanted, status);
    return NULL;
  }
  handed_out += bytes;
  if (alignment == huge_page) madvise(pointer, bytes, MADV_HUGEPAGE);
  return memset(pointer, 0, bytes);
}

bool memory_grow(void *array, size_t *capacity, size_t count, size_t size, const char *what, struct status *status)
{
  if (count <= *capacity) return true;
  size_t larger = *capacity + *capacity / 2;
  if (larger < count) larger = count;
  void *old;
  memcpy(&old, array, sizeof old);
  void *grown = memory_allocate(larger, size, what, status);
  if (!grown) return false;
  if (old) memcpy(grown, old, *capacity * size);
  free(old);
  memcpy(array, &grown, sizeof grown);
  *capacity = larger;
  return true;
}

void *memory_map(size_t bytes, const char *what, struct status *status)
{
  if (!is_within_budget(what, (double)bytes, status)) return NULL;
  size_t length = round_up(bytes, huge_page);
  char *pointer = mmap(NULL, length + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pointer == MAP_FAILED) {
    out_of_memory(what, (double)bytes, status);
    return NULL;
  }
  size_t skip = round_up((uintptr_t)pointer, huge_page) - (uintptr_t)pointer;
  if (skip) munmap(pointer, skip);
  if (skip < huge_page) munmap(pointer + skip + length, huge_page - skip);
  madvise(pointer + skip, length, MADV_HUGEPAGE); /* may fail: results are the same with small pages */
  handed_out += length;
  return pointer + skip;
}

void memory_unmap(void *pointer, size_t bytes)
{
  if (pointer) munmap(pointer, round_up(bytes, huge_page));
}

double memory_peak_mib(void)
{
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)usage.ru_maxrss / 1024.0;
}
