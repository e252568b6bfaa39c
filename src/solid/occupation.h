/* Occupation: the cells of each disc, of its hydraulic shape (discs.h), and the owner weights w_p B of these cells
 * (fluid/runs.h), as runs of cells in rows.
 *
 * Contract. After stage_occupation the tables describe the poses in `discs`: occupation_row has the runs of a row from
 * left to right, and occupation_sums has the sums that the sweep has taken over one run. The cells of a disc beyond a
 * wall have no run; across a periodic side the runs wrap. The tables depend on poses and indices alone, so that they
 * are the same bits for any number of threads and after a restart. Design: occupation.c. */
#ifndef DELBM_SOLID_OCCUPATION_H
#define DELBM_SOLID_OCCUPATION_H

#include "base/team.h"
#include "solid/tables.h"

/* Allocates the tables of the scene's discs; stage_occupation fills them. */
bool occupation_create(struct occupation *occupation, const struct scene *scene, const struct discs *discs,
                       struct status *status);
void occupation_destroy(struct occupation *occupation);

/* Updates the tables to the poses of the discs. Called by all threads of a parallel region, or outside of one. Fails if
 * memory runs out. */
bool stage_occupation(struct occupation *occupation, const struct discs *discs, struct team *team);

/* Occupation fraction min(1, sum eps_p) of each cell of row y. `scratch`: room for the widest row of a disc and
 * SHAPE_PAD more. */
void occupation_fractions(const struct occupation *occupation, const struct discs *discs, int y, double *eps,
                          double *scratch);

#endif
