/* A picture has three layers: the raster (the quantity, averaged over the cells of a pixel if the domain is larger
 * than the picture), the colours (the raster mapped to colours, interpolated if a cell has many pixels), and the
 * discs. Lengths of discs are in pixels, y upwards from the lower edge; the image stores its rows from the top. */
#include "output/picture.h"

#include "base/memory.h"
#include "fluid/vorticity.h"
#include "output/file.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 3, ANCHORS = 9, COMPRESSION = 4 };

/* Colours at equal distances along a scale. */
struct colour_map {
  enum picture_colour anchors[ANCHORS];
};

/* Matplotlib's "inferno": dark at rest, lightness rising evenly with speed. */
static const struct colour_map speed_map = {
    {0x000004, 0x210c4a, 0x56106e, 0x89226a, 0xbb3754, 0xe35932, 0xf98c0a, 0xf9c932, 0xfcffa4}};

/* Blue for clockwise, orange for counter-clockwise, equally light at equal distance from the dark middle. */
static const struct colour_map vorticity_map = {
    {0xc4ecff, 0x5ab4f0, 0x2170be, 0x133a6b, 0x0b0c14, 0x6b1f1a, 0xc2481a, 0xf5982c, 0xffe8ae}};

/* Blue, cyan, green, white: lightness rises along the scale, and no hue of speed_map occurs. */
static const struct colour_map disc_map = {
    {0x3b5bff, 0x2f8dff, 0x22bdf5, 0x1fdcc6, 0x35e27e, 0x86ec5a, 0xc9f57a, 0xeafbb8, 0xffffff}};

struct raster {
  int width, height;
  double *values; /* row by row from the bottom */
};

struct image {
  int width, height;
  uint8_t *pixels; /* row by row from the top */
};

/* Pixels on a domain of `size` cells: one a cell. If the longer side has more than PICTURE_LARGEST cells, a pixel
 * averages `block` x `block` cells; if fewer than PICTURE_SMALLEST, a cell is `zoom` x `zoom` pixels. */
enum { PICTURE_LARGEST = 1600, PICTURE_SMALLEST = 400 };
struct scale {
  int block;
  int zoom;
  int width, height; /* pixels */
};

static struct scale scale_of(const int size[2])
{
  int longer = size[0] > size[1] ? size[0] : size[1];
  struct scale scale = {.block = 1, .zoom = 1};
  if (longer > PICTURE_LARGEST) scale.block = (longer + PICTURE_LARGEST - 1) / PICTURE_LARGEST;
  if (longer < PICTURE_SMALLEST) scale.zoom = 2 * PICTURE_SMALLEST / longer;
  scale.width = (size[0] + scale.block - 1) / scale.block * scale.zoom;
  scale.height = (size[1] + scale.block - 1) / scale.block * scale.zoom;
  return scale;
}

static double cell_value(const struct picture *picture, int i, int j)
{
  ptrdiff_t row = picture->size[0], cell = j * row + i;
  if (picture->quantity == FRAME_VORTICITY) {
    const struct stencil x = stencil_at(i, picture->size[0], picture->periodic[0]);
    const struct stencil y = stencil_at(j, picture->size[1], picture->periodic[1]);
    return stencil_slope(&x, picture->uy[j * row + x.low], picture->uy[j * row + x.high]) -
           stencil_slope(&y, picture->ux[y.low * row + i], picture->ux[y.high * row + i]);
  }
  double ux = picture->ux[cell], uy = picture->uy[cell];
  return sqrt(ux * ux + uy * uy);
}

static double block_mean(const struct picture *picture, int block, int column, int row)
{
  int right = (column + 1) * block < picture->size[0] ? (column + 1) * block : picture->size[0];
  int top = (row + 1) * block < picture->size[1] ? (row + 1) * block : picture->size[1];
  double sum = 0;
  for (int j = row * block; j < top; j++)
    for (int i = column * block; i < right; i++) sum += cell_value(picture, i, j);
  return sum / ((double)(right - column * block) * (top - row * block));
}

static void raster_fill(struct raster *raster, const struct picture *picture, int block)
{
  if (!picture->ux) return;
#pragma omp parallel for schedule(static)
  for (int row = 0; row < raster->height; row++)
    for (int column = 0; column < raster->width; column++)
      raster->values[(ptrdiff_t)row * raster->width + column] = block_mean(picture, block, column, row);
}

static double raster_largest(const struct raster *raster)
{
  double largest = 0;
  for (ptrdiff_t k = 0; k < (ptrdiff_t)raster->width * raster->height; k++)
    largest = fmax(largest, fabs(raster->values[k]));
  return largest;
}

static double clamp(double value, double low, double high)
{
  return value > low ? (value < high ? value : high) : low;
}

/* Linear interpolation of the raster, constant beyond its edge. */
static double raster_at(const struct raster *raster, double x, double y)
{
  x = clamp(x, 0, raster->width - 1);
  y = clamp(y, 0, raster->height - 1);
  int i = (int)x, j = (int)y;
  double right = x - i, up = y - j;
  const double *low = raster->values + (ptrdiff_t)j * raster->width + i;
  const double *high = up > 0 ? low + raster->width : low;
  int next = right > 0;
  return (1 - up) * ((1 - right) * low[0] + right * low[next]) + up * ((1 - right) * high[0] + right * high[next]);
}

static double channel(enum picture_colour colour, int which)
{
  return (double)((unsigned)colour >> (8 * (CHANNELS - 1 - which)) & 0xff);
}

/* The colour at `place`, from 0 (low end of the scale) to 1 (high end). */
static void map_colour(const struct colour_map *map, double place, uint8_t *pixel)
{
  double scaled = clamp(place, 0, 1) * (ANCHORS - 1);
  int low = scaled < ANCHORS - 2 ? (int)scaled : ANCHORS - 2;
  double share = scaled - low;
  for (int k = 0; k < CHANNELS; k++)
    pixel[k] = (uint8_t)(0.5 + (1 - share) * channel(map->anchors[low], k) + share * channel(map->anchors[low + 1], k));
}

static uint8_t *image_pixel(const struct image *image, int column, int row)
{
  return image->pixels + CHANNELS * ((ptrdiff_t)(image->height - 1 - row) * image->width + column);
}

/* Value at the end of the quantity's scale. */
static double scale_end(const struct picture *picture, const struct raster *raster)
{
  const double maximum = picture->maximum > 0 ? picture->maximum : raster_largest(raster);
  return maximum > 0 ? maximum : 1;
}

static void paint_raster(struct image *image, const struct raster *raster, const struct picture *picture,
                         double maximum)
{
  bool signed_values = picture->quantity == FRAME_VORTICITY;
  const struct colour_map *map = signed_values ? &vorticity_map : &speed_map;
  double factor = (signed_values ? 0.5 : 1) / maximum, rest = signed_values ? 0.5 : 0;
  double points = (double)raster->width / image->width;
#pragma omp parallel for schedule(static)
  for (int row = 0; row < image->height; row++)
    for (int column = 0; column < image->width; column++) {
      double value = raster_at(raster, (column + 0.5) * points - 0.5, (row + 0.5) * points - 0.5);
      map_colour(map, rest + factor * value, image_pixel(image, column, row));
    }
}

static void blend(uint8_t *pixel, enum picture_colour colour, double share)
{
  for (int k = 0; k < CHANNELS; k++) pixel[k] = (uint8_t)(0.5 + (1 - share) * pixel[k] + share * channel(colour, k));
}

/* Fraction of a pixel inside an edge `distance` pixels outwards of the pixel's centre. */
static double coverage(double distance)
{
  return clamp(distance + 0.5, 0, 1);
}

/* A disc on the picture, in pixels; cosine and sine of its angle; its colour, and whether the colour is
 * PICTURE_DISC. */
struct drawn_disc {
  double x, y, radius;
  double cosine, sine;
  bool plain;
  uint8_t inside[CHANNELS];
};

/* Opacity of the spin mark at (x, y) from the centre: two opposite quadrants, in small discs a line from centre to
 * rim. */
static double mark_coverage(const struct drawn_disc *disc, double x, double y)
{
  enum { QUADRANTS_FROM = 6, LINE_FROM = 2 };
  double along = x * disc->cosine + y * disc->sine, across = y * disc->cosine - x * disc->sine;
  if (disc->radius >= QUADRANTS_FROM) {
    double edge = fmin(fabs(along), fabs(across));
    return coverage(along * across > 0 ? edge : -edge);
  }
  if (disc->radius < LINE_FROM) return 0;
  return coverage(0.5 - hypot(fmin(along, 0), across));
}

static void draw_disc_pixel(const struct drawn_disc *disc, double x, double y, uint8_t *pixel)
{
  double inwards = disc->radius - sqrt(x * x + y * y);
  double covered = coverage(inwards);
  if (!(covered > 0)) return;
  double outline = fmin(1.25, 0.2 * disc->radius);
  uint8_t inside[CHANNELS];
  for (int k = 0; k < CHANNELS; k++) inside[k] = disc->inside[k];
  if (disc->plain) blend(inside, PICTURE_MARK, mark_coverage(disc, x, y));
  blend(inside, PICTURE_OUTLINE, coverage(outline - inwards));
  blend(pixel, (enum picture_colour)(inside[0] << 16 | inside[1] << 8 | inside[2]), covered);
}

static int pixel_index(double place, int count)
{
  return (int)clamp(floor(place), 0, count);
}

static void draw_disc(struct image *image, const struct drawn_disc *disc)
{
  int left = pixel_index(disc->x - disc->radius - 1, image->width);
  int right = pixel_index(disc->x + disc->radius + 2, image->width);
  int bottom = pixel_index(disc->y - disc->radius - 1, image->height);
  int top = pixel_index(disc->y + disc->radius + 2, image->height);
  for (int row = bottom; row < top; row++)
    for (int column = left; column < right; column++)
      draw_disc_pixel(disc, column + 0.5 - disc->x, row + 0.5 - disc->y, image_pixel(image, column, row));
}

/* Disc n at its own position, without periodic images. */
static struct drawn_disc drawn_disc(const struct picture *picture, size_t n, double pixels, double values_end)
{
  const struct discs *discs = picture->discs;
  struct drawn_disc disc = {.x = pixels * discs->x[n],
                            .y = pixels * discs->y[n],
                            .radius = pixels * discs->radius[n],
                            .cosine = cos(discs->angle[n]),
                            .sine = sin(discs->angle[n]),
                            .plain = !picture->values};
  for (int k = 0; k < CHANNELS; k++) disc.inside[k] = (uint8_t)channel(PICTURE_DISC, k);
  if (picture->values) map_colour(&disc_map, picture->values[n] / values_end, disc.inside);
  return disc;
}

static void draw_discs(struct image *image, const struct picture *picture, double pixels, double values_end)
{
  int repeat_x = picture->periodic[0], repeat_y = picture->periodic[1];
  for (size_t n = 0; n < picture->discs->count; n++) {
    const struct drawn_disc disc = drawn_disc(picture, n, pixels, values_end);
    for (int up = -repeat_y; up <= repeat_y; up++)
      for (int right = -repeat_x; right <= repeat_x; right++) {
        struct drawn_disc shown = disc;
        shown.x += pixels * right * picture->size[0];
        shown.y += pixels * up * picture->size[1];
        draw_disc(image, &shown);
      }
  }
}

static void write_rows(png_structp png, png_infop info, const struct image *image, FILE *stream)
{
  png_init_io(png, stream);
  png_set_compression_level(png, COMPRESSION);
  png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int row = image->height - 1; row >= 0; row--) png_write_row(png, image_pixel(image, 0, row));
  png_write_end(png, info);
}

/* Argument of on_error, passed through libpng. */
struct destination {
  const char *path;
  struct status *status;
};

/* Returns to the setjmp in image_write. */
static void on_error(png_structp png, png_const_charp message)
{
  const struct destination *to = png_get_error_ptr(png);
  status_fail(to->status, DELBM_IO, "cannot write %s: %s", to->path, errno ? strerror(errno) : message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
  (void)png;
  (void)message;
}

static bool image_write(const struct image *image, FILE *stream, struct destination *to)
{
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, to, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info) {
    png_destroy_write_struct(&png, NULL);
    return status_fail(to->status, DELBM_FAILED, "out of memory: a picture");
  }
  errno = 0;
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  write_rows(png, info, image, stream);
  png_destroy_write_struct(&png, &info);
  return true;
}

static bool image_save(const struct image *image, const char *path, struct status *status)
{
  struct replacement file;
  struct destination to = {.path = path, .status = status};
  if (!replacement_begin(&file, path, status)) return false;
  if (image_write(image, file.stream, &to)) return replacement_commit(&file, status);
  replacement_abandon(&file);
  return false;
}

bool picture_write(const struct picture *picture, const char *path, struct status *status)
{
  struct scale scale = scale_of(picture->size);
  struct raster raster = {.width = scale.width / scale.zoom, .height = scale.height / scale.zoom};
  struct image image = {.width = scale.width, .height = scale.height};
  size_t points = (size_t)raster.width * (size_t)raster.height, pixels = (size_t)image.width * (size_t)image.height;
  raster.values = memory_allocate(points, sizeof *raster.values, "a picture", status);
  if (raster.values) image.pixels = memory_allocate(pixels, CHANNELS, "a picture", status);
  bool drawn = raster.values && image.pixels;
  if (drawn) {
    raster_fill(&raster, picture, scale.block);
    const double maximum = scale_end(picture, &raster);
    paint_raster(&image, &raster, picture, maximum);
    draw_discs(&image, picture, (double)scale.zoom / scale.block,
               picture->values_end > 0 ? picture->values_end : maximum);
  }
  free(raster.values);
  bool saved = drawn && image_save(&image, path, status);
  free(image.pixels);
  return saved;
}
