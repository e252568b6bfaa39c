/* Overlap area of two bodies by cells, the paper's (23) and (24): over all cells of the box that both cover, with fractions eps_a
 * and eps_b, the sum of max(0, eps_a + eps_b - A_m), A_m = 0.95. */
#ifndef DELBM_CONTACT_CELLS_AREA_H
#define DELBM_CONTACT_CELLS_AREA_H

#include "solid/discs.h"

static const double cells_area_minimum = 0.95; /* A_m */

/* From this gap between the bodies on the area is 0: the part of a cell between two lines at distance g that both cross the cell is
 * at least g^2 (a corner cut off at 45 degrees), and a cell counts only where that part is below 1 - A_m. */
static const double cells_area_gap = 0.2237;

/* Numbers of scratch that cells_area needs for these discs. */
size_t cells_area_scratch(const struct discs *discs);

double cells_area(const struct scene *scene, const struct discs *discs, uint32_t a, uint32_t b, double *scratch);

#endif
