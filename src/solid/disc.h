/* Members of struct shape_kind (shape.h) of a disc, except those of disc_kernel.c. */
#ifndef DELBM_SOLID_DISC_H
#define DELBM_SOLID_DISC_H

#include "solid/shape.h"

double disc_area(const struct shape *disc);
double disc_gyration2(const struct shape *disc);
struct shape_box disc_box(const struct shape *disc, const struct pose *pose);

#endif
