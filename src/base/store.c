#include "base/store.h"

#include <errno.h>
#include <string.h>
#include <zlib.h>

enum { MARK = 16 };

bool store_bytes(struct store *store, void *data, size_t size, struct status *status)
{
  errno = 0;
  const size_t moved = store->saving ? fwrite(data, 1, size, store->stream) : fread(data, 1, size, store->stream);
  if (moved < size && store->saving)
    return status_fail(status, DELBM_IO, "cannot write %s: %s", store->path, strerror(errno ? errno : EIO));
  if (moved < size)
    return status_fail(status, DELBM_IO, "cannot read %s: %s", store->path, errno ? strerror(errno) : "it ends early");
  store->sum = (uint32_t)crc32_z(store->sum, data, size);
  return true;
}

bool store_mark(struct store *store, const char *name, struct status *status)
{
  char mark[MARK] = {0};
  if (store->saving) snprintf(mark, MARK, "%s", name);
  if (!store_bytes(store, mark, MARK, status)) return false;
  if (strncmp(mark, name, MARK) == 0) return true;
  return status_fail(status, DELBM_IO, "cannot read %s: %s expected, '%.*s' found", store->path, name, MARK, mark);
}
