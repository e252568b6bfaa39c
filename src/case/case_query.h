/* Questions to a case while it is read, for checks that concern several keys. */
#ifndef DELBM_CASE_CASE_QUERY_H
#define DELBM_CASE_CASE_QUERY_H

#include "case/case_draft.h"

/* True if the case gives the key (with any value). */
bool draft_gives(const struct draft *draft, const char *path);

/* True if the key's value can be relied on: given as the table allows, or left to its default. */
bool draft_knows(const struct draft *draft, const char *path);

/* fluid.collision as given, or what the other keys imply. */
enum collision draft_collision(const struct draft *draft);

/* Records an error at the key's place: `got` its value, or that it is missing, and what is expected instead. */
void draft_refuse(struct draft *draft, const char *path, const char *expected, ...)
    __attribute__((format(printf, 3, 4)));

/* The region of particles.fill: as given, or the box. */
void draft_fill_region(const struct draft *draft, double region[4]);

#endif
