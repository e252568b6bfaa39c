/* frames/NNNNNNNN.png: the flow as colour and the discs on top, y upwards. Equal input leads to equal bytes. */
#ifndef DELBM_OUTPUT_PICTURE_H
#define DELBM_OUTPUT_PICTURE_H

#include "solid/discs.h"

/* Colours of plain discs, as 0xRRGGBB. The dark quadrants show the disc's angle. */
enum picture_colour { PICTURE_DISC = 0xf0f1f4, PICTURE_MARK = 0x868d9b, PICTURE_OUTLINE = 0x14161c };

struct picture {
  int size[2];           /* cells, x then y */
  const double *ux, *uy; /* velocity of the cells, row by row from the bottom; NULL without fluid: as at rest */
  bool periodic[2];      /* discs across such a side appear on both */
  const struct discs *discs;
  enum frame_quantity quantity;
  double maximum;       /* value at the end of the colour scale; 0: the largest of this picture */
  const double *values; /* of each disc, shown as its colour from blue to white; NULL: plain discs */
  double values_end;    /* end of the discs' scale, which starts at 0; 0: the end of the quantity's scale */
};

/* Draws and writes one picture. A build without libpng refuses. */
#ifdef DELBM_PNG
enum { PICTURE_SUPPORTED = 1 };
bool picture_write(const struct picture *picture, const char *path, struct status *status);
#else
enum { PICTURE_SUPPORTED = 0 };
static inline bool picture_write(const struct picture *picture, const char *path, struct status *status)
{
  (void)picture;
  return status_fail(status, DELBM_FAILED, "cannot write %s: this build has no libpng", path);
}
#endif

#endif
