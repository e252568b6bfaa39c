#include "output/checkpoint.h"

#include "base/memory.h"
#include "output/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static const char magic[8] = "delbm\r\n";
static const uint32_t order = 0x01020304;

enum { FORMAT = 9, BUFFER = 1 << 16 };

static bool store_record(struct run_record *record, struct store *store, struct status *status)
{
  return store_mark(store, "record", status) && store_bytes(store, record, sizeof *record, status);
}

static bool write_sum(struct store *store, struct status *status)
{
  uint32_t sum = store->sum;
  return store_bytes(store, &sum, sizeof sum, status);
}

bool checkpoint_write(const char *path, uint32_t fingerprint, struct simulation *simulation,
                      const struct run_record *record, struct status *status)
{
  struct replacement file;
  struct checkpoint_head head = {
      .order = order, .format = FORMAT, .fingerprint = fingerprint, .step = simulation_step(simulation)};
  struct run_record copy = *record;
  memcpy(head.magic, magic, sizeof magic);
  snprintf(head.kernel, sizeof head.kernel, "%s", simulation_kernel(simulation));
  if (!replacement_begin(&file, path, status)) return false;
  setvbuf(file.stream, NULL, _IOFBF, BUFFER);
  struct store store = {.stream = file.stream, .path = path, .saving = true};
  if (store_bytes(&store, &head, sizeof head, status) && simulation_save(simulation, &store, status) &&
      store_record(&copy, &store, status) && write_sum(&store, status))
    return replacement_commit_durably(&file, status);
  replacement_abandon(&file);
  return false;
}

static bool refuse(struct status *status, const char *path, const char *reason)
{
  return status_fail(status, DELBM_IO, "%s: %s", path, reason);
}

static bool check_head(const char *path, const struct checkpoint_head *head, uint32_t fingerprint,
                       struct status *status)
{
  if (memcmp(head->magic, magic, sizeof magic) != 0) return refuse(status, path, "not a checkpoint of delbm");
  if (head->order != order) return refuse(status, path, "from a machine with another order of bytes");
  if (head->format != FORMAT)
    return status_fail(status, DELBM_IO, "%s: of format %u; this delbm (%s) reads format %d", path, head->format,
                       DELBM_VERSION, FORMAT);
  if (head->fingerprint != fingerprint)
    return refuse(status, path, "of another case: domain, fluid, units, coupling, particles or contact differ");
  return true;
}

/* Compares the CRC-32 of the head and the rest of the file with the sum in its last bytes. */
static bool check_sum(FILE *stream, const char *path, const struct checkpoint_head *head, struct status *status)
{
  uint32_t sum = (uint32_t)crc32_z(0, (const void *)head, sizeof *head), found = 0;
  unsigned char *buffer = memory_allocate(BUFFER, 1, "a checkpoint", status);
  if (!buffer) return false;
  size_t kept = 0, got; /* the last bytes read may be the sum, and are kept in the buffer */
  while ((got = fread(buffer + kept, 1, BUFFER - kept, stream)) > 0) {
    kept += got;
    if (kept <= sizeof found) continue;
    sum = (uint32_t)crc32_z(sum, buffer, kept - sizeof found);
    memmove(buffer, buffer + kept - sizeof found, sizeof found);
    kept = sizeof found;
  }
  const bool failed = ferror(stream);
  if (kept == sizeof found) memcpy(&found, buffer, sizeof found);
  free(buffer);
  if (failed) return file_fail(status, "read", path, errno);
  return (kept == sizeof found && found == sum) ||
         refuse(status, path, "damaged or incomplete: its checksum does not match");
}

static FILE *open_checkpoint(const char *path, struct status *status)
{
  FILE *stream = file_open_stream(path, status);
  if (stream) setvbuf(stream, NULL, _IOFBF, BUFFER);
  return stream;
}

static bool examine(FILE *stream, const char *path, uint32_t fingerprint, struct checkpoint_head *head,
                    struct status *status)
{
  return (fread(head, sizeof *head, 1, stream) == 1 || refuse(status, path, "not a checkpoint of delbm")) &&
         check_head(path, head, fingerprint, status) && check_sum(stream, path, head, status);
}

bool checkpoint_examine(const char *path, uint32_t fingerprint, struct checkpoint_head *head, struct status *status)
{
  FILE *stream = open_checkpoint(path, status);
  if (!stream) return false;
  const bool good = examine(stream, path, fingerprint, head, status);
  fclose(stream);
  return good;
}

static bool restore(FILE *stream, const char *path, struct simulation *simulation, struct run_record *record,
                    struct status *status)
{
  struct checkpoint_head head;
  struct store store = {.stream = stream, .path = path};
  return store_bytes(&store, &head, sizeof head, status) && simulation_restore(simulation, &store, status) &&
         store_record(record, &store, status) &&
         (simulation_step(simulation) == head.step || refuse(status, path, "its state is of another step"));
}

bool checkpoint_read(const char *path, struct simulation *simulation, struct run_record *record, struct status *status)
{
  FILE *stream = open_checkpoint(path, status);
  if (!stream) return false;
  const bool restored = restore(stream, path, simulation, record, status);
  fclose(stream);
  return restored;
}

bool checkpoint_load(const char *path, uint32_t fingerprint, struct simulation *simulation, bool *lost,
                     struct status *status)
{
  struct checkpoint_head head;
  struct run_record record;
  if (!simulation_usable(simulation, status)) return false;
  FILE *stream = open_checkpoint(path, status);
  if (!stream) return false;
  bool loaded = examine(stream, path, fingerprint, &head, status);
  if (loaded) {
    rewind(stream);
    loaded = restore(stream, path, simulation, &record, status);
    *lost = !loaded;
  }
  fclose(stream);
  return loaded;
}
