#include "output/hdf5_file.h"

#include "output/file.h"

#include <stdlib.h>

/* What HDF5 knows of an open file: its own part first. */
struct driven {
  H5FD_t base;
  struct hdf5_file *open;
  haddr_t eoa; /* end of what HDF5 has given out */
};

static struct driven *driven_of(const H5FD_t *base)
{
  return (struct driven *)(void *)base;
}

static H5FD_t *driver_open(const char *name, unsigned flags, hid_t access, haddr_t most)
{
  (void)name, (void)flags, (void)most;
  struct hdf5_file *const *open = H5Pget_driver_info(access);
  struct driven *driven = open ? calloc(1, sizeof *driven) : NULL;
  if (!driven) return NULL;
  driven->open = *open;
  return &driven->base;
}

static herr_t driver_close(H5FD_t *base)
{
  free(driven_of(base));
  return 0;
}

/* As HDF5's own driver for plain files. */
static herr_t driver_query(const H5FD_t *base, unsigned long *flags)
{
  (void)base;
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

static haddr_t driver_get_eoa(const H5FD_t *base, H5FD_mem_t type)
{
  (void)type;
  return driven_of(base)->eoa;
}

static herr_t driver_set_eoa(H5FD_t *base, H5FD_mem_t type, haddr_t eoa)
{
  (void)type;
  driven_of(base)->eoa = eoa;
  return 0;
}

static haddr_t driver_get_eof(const H5FD_t *base, H5FD_mem_t type)
{
  (void)type;
  return (haddr_t)driven_of(base)->open->file->length;
}

static herr_t driver_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t from, size_t size, void *to)
{
  (void)type, (void)transfer;
  return reversible_read(driven_of(base)->open->file, to, size, (int64_t)from) == 0 ? 0 : -1;
}

/* An error is kept for hdf5_close to tell: HDF5 cannot close a file whose writes fail. */
static herr_t driver_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t to, size_t size, const void *from)
{
  (void)type, (void)transfer;
  struct hdf5_file *open = driven_of(base)->open;
  if (open->error == 0) open->error = reversible_write(open->file, from, size, (int64_t)to);
  return 0;
}

static herr_t driver_truncate(H5FD_t *base, hid_t transfer, hbool_t closing)
{
  (void)transfer, (void)closing;
  struct hdf5_file *open = driven_of(base)->open;
  const int64_t end = (int64_t)driven_of(base)->eoa;
  if (open->error == 0 && open->file->length != end) open->error = reversible_set_length(open->file, end);
  return 0;
}

static const H5FD_class_t driver = {
    .name = "delbm",
    .maxaddr = ((haddr_t)1 << 62) - 1,
    .fc_degree = H5F_CLOSE_STRONG,
    .fapl_size = sizeof(struct hdf5_file *),
    .open = driver_open,
    .close = driver_close,
    .query = driver_query,
    .get_eoa = driver_get_eoa,
    .set_eoa = driver_set_eoa,
    .get_eof = driver_get_eof,
    .read = driver_read,
    .write = driver_write,
    .truncate = driver_truncate,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

bool hdf5_open(struct hdf5_file *open, struct reversible *file, struct status *status)
{
  H5dont_atexit(); /* all is closed by then, and of a file that could not be closed HDF5 would crash at the exit */
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* errors are told by us */
  *open = (struct hdf5_file){.file = file, .handle = -1, .driver = H5FDregister(&driver)};
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  if (access >= 0 && open->driver >= 0 && H5Pset_driver(access, open->driver, &open) >= 0)
    open->handle = file->length == 0 ? H5Fcreate(file->path, H5F_ACC_TRUNC, H5P_DEFAULT, access)
                                     : H5Fopen(file->path, H5F_ACC_RDWR, access);
  if (access >= 0) H5Pclose(access);
  if (open->handle >= 0) return true;
  if (open->driver >= 0) H5FDunregister(open->driver);
  return status_fail(status, DELBM_IO, "cannot open %s: HDF5 does not take it", file->path);
}

bool hdf5_close(struct hdf5_file *open, struct status *status)
{
  const bool closed = H5Fclose(open->handle) >= 0;
  H5FDunregister(open->driver);
  if (open->error) return file_fail(status, "write", open->file->path, open->error);
  return closed || status_fail(status, DELBM_IO, "cannot write %s: HDF5 does not close it", open->file->path);
}
