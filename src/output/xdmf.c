#include "output/xdmf.h"

#include "output/file.h"

#include <errno.h>
#include <inttypes.h>

static const char head[] = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
                           "<Grid Name=\"series\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
static const char tail[] = "</Grid>\n</Domain>\n</Xdmf>\n";

/* Larger than a snapshot, so that each addition is one write. */
enum { BUFFER = 1 << 14 };

enum kind { SCALAR, VECTOR, NUMBER };

/* A quantity of every cell or disc. */
struct attribute {
  const char *name;
  enum kind kind;
};

static const struct attribute of_cells[] = {
    {"rho", SCALAR}, {"velocity", VECTOR}, {"vorticity", SCALAR}, {"pressure", SCALAR}, {"occupation", SCALAR}};
static const struct attribute of_discs[] = {
    {"radius", SCALAR}, {"velocity", VECTOR}, {"angle", SCALAR}, {"spin", SCALAR}, {"id", NUMBER}};

/* Datasets of a snapshot, or of a part of it: "/discs". */
struct values {
  const char *dimensions;
  int64_t step;
  const char *part;
};

static void write_item(FILE *file, const struct values *values, const char *name, enum kind kind)
{
  fprintf(file,
          "<DataItem Dimensions=\"%s%s\" NumberType=\"%s\" Precision=\"8\" Format=\"HDF\">"
          "fields.h5:/%08" PRId64 "%s/%s</DataItem>",
          values->dimensions, kind == VECTOR ? " 3" : "", kind == NUMBER ? "Int" : "Float", values->step, values->part,
          name);
}

static void write_attributes(FILE *file, const struct values *values, const struct attribute *attributes, size_t count)
{
  for (const struct attribute *a = attributes; a < attributes + count; a++) {
    fprintf(file, "<Attribute Name=\"%s\" Center=\"Node\" AttributeType=\"%s\">", a->name,
            a->kind == VECTOR ? "Vector" : "Scalar");
    write_item(file, values, a->name, a->kind);
    fputs("</Attribute>\n", file);
  }
}

/* Samples as points of a mesh, at the centres of their cells. The mesh has three dimensions, listed z, y, x, one
 * layer in z: ParaView 5.11 rotates a two-dimensional mesh upright, and ignores values of cells without thickness. */
static void write_flow(FILE *file, const struct sample_grid *grid, int64_t step)
{
  char dimensions[64];
  snprintf(dimensions, sizeof dimensions, "1 %d %d", grid->count[1], grid->count[0]);
  const struct values values = {dimensions, step, ""};
  fprintf(file,
          "<Grid Name=\"flow\">\n<Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"%s\"/>\n"
          "<Geometry GeometryType=\"ORIGIN_DXDYDZ\">"
          "<DataItem Dimensions=\"3\" Format=\"XML\">0 %d.5 %d.5</DataItem>"
          "<DataItem Dimensions=\"3\" Format=\"XML\">1 %d %d</DataItem></Geometry>\n",
          dimensions, grid->first[1], grid->first[0], grid->stride, grid->stride);
  write_attributes(file, &values, of_cells, sizeof of_cells / sizeof of_cells[0]);
  fputs("</Grid>\n", file);
}

static void write_discs(FILE *file, size_t points, int64_t step)
{
  char dimensions[32];
  snprintf(dimensions, sizeof dimensions, "%zu", points);
  const struct values values = {dimensions, step, "/discs"};
  fprintf(file,
          "<Grid Name=\"discs\">\n<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%zu\"/>\n"
          "<Geometry GeometryType=\"XYZ\">",
          points);
  write_item(file, &values, "position", VECTOR);
  fputs("</Geometry>\n", file);
  write_attributes(file, &values, of_discs, sizeof of_discs / sizeof of_discs[0]);
  fputs("</Grid>\n", file);
}

static bool flushed(struct xdmf *xdmf, struct status *status)
{
  return (!ferror(xdmf->stream) && fflush(xdmf->stream) == 0) || file_fail(status, "write", xdmf->path, errno);
}

bool xdmf_open(struct xdmf *xdmf, const char *path, const struct sample_grid *grid, struct status *status)
{
  *xdmf = (struct xdmf){.path = path, .grid = *grid, .stream = file_create_stream(path, status)};
  if (!xdmf->stream) return false;
  setvbuf(xdmf->stream, NULL, _IOFBF, BUFFER);
  fputs(head, xdmf->stream);
  fputs(tail, xdmf->stream);
  return flushed(xdmf, status);
}

bool xdmf_add(struct xdmf *xdmf, int64_t step, size_t points, struct status *status)
{
  FILE *file = xdmf->stream;
  if (!file_stays(fileno(file), xdmf->path, status)) return false;
  if (fseek(file, -(long)(sizeof tail - 1), SEEK_END) != 0) return file_fail(status, "write", xdmf->path, errno);
  fprintf(file,
          "<Grid Name=\"step %" PRId64 "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
          "<Time Value=\"%" PRId64 "\"/>\n",
          step, step);
  write_flow(file, &xdmf->grid, step);
  if (points > 0) write_discs(file, points, step);
  fputs("</Grid>\n", file);
  fputs(tail, file);
  return flushed(xdmf, status);
}

bool xdmf_close(struct xdmf *xdmf, struct status *status)
{
  if (!xdmf->stream) return true;
  const bool closed = fclose(xdmf->stream) == 0 || file_fail(status, "close", xdmf->path, errno);
  xdmf->stream = NULL;
  return closed;
}
