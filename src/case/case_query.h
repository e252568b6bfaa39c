/* Queries of a draft, for checks of several keys. */
#ifndef DELBM_CASE_CASE_QUERY_H
#define DELBM_CASE_CASE_QUERY_H

#include "case/case_draft.h"
#include "case/case_keys.h"

/* True if the case has the key (with any value). */
bool draft_has(const struct draft *draft, const char *path);

/* True if the case must have the key. */
bool draft_requires(const struct draft *draft, const struct key *key);

/* True if the value of the key is valid: allowed by the table, or the default. */
bool draft_knows(const struct draft *draft, const char *path);

/* True if the value of the key is `auto`, written or as the default. */
bool draft_is_auto(const struct draft *draft, const char *path);

/* fluid.collision of the case, or its default for the other keys. */
enum collision draft_collision(const struct draft *draft);

/* Records an error at the place of the key: its value, or that it is missing, and the expected value. */
void draft_refuse(struct draft *draft, const char *path, const char *expected, ...)
    __attribute__((format(printf, 3, 4)));

/* particles.fill.region, by default the box. */
void draft_fill_region(const struct draft *draft, double region[4]);

#endif
