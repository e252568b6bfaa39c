/* Overlap area of two bodies by cells, (23) and (24): sum of max(0, eps_a + eps_b - A_m), A_m = 0.95, over all cells
 * of the box with fractions eps_a > 0 and eps_b > 0. */
#ifndef DELBM_CONTACT_CELLS_AREA_H
#define DELBM_CONTACT_CELLS_AREA_H

#include "solid/discs.h"

static const double cells_area_minimum = 0.95; /* A_m */

/* Gap from which the area is 0, sqrt(1 - A_m): two lines at distance g that both cross a cell have at least g^2 of
 * the cell between them (a corner cut off at 45 degrees), and the cell counts only if this part is below 1 - A_m. */
static const double cells_area_gap = 0.2237;

/* Length of `scratch` for any two of the discs. */
size_t cells_area_scratch(const struct discs *discs);

double cells_area(const struct scene *scene, const struct discs *discs, uint32_t a, uint32_t b, double *scratch);

#endif
