/* The recorded maps of stability, bench/results/...-stability.json, the last by name: rules of thumb are tested on them. */
#ifndef DELBM_TESTS_MAPS_H
#define DELBM_TESTS_MAPS_H

#include "json.h"

#include <criterion/criterion.h>
#include <glob.h>

/* The text of the report; released by free(). */
static inline char *maps_read(void)
{
  glob_t found;
  cr_assert_eq(glob(TEST_DIR "/../bench/results/*-stability.json", 0, NULL, &found), 0);
  char *text = json_read(found.gl_pathv[found.gl_pathc - 1]);
  cr_assert(text);
  globfree(&found);
  return text;
}

/* First letter of the verdict, c(ompleted), i(naccurate) or d(iverged), of a place of a map. */
static inline char maps_verdict(const char *report, const char *map, const char *row, int column)
{
  const char *at = json_member(json_member(report, "stability"), map);
  cr_assert(at, "no map '%s'", map);
  at = json_member(json_member(at, "rows"), row);
  cr_assert(at, "no row '%s' in '%s'", row, map);
  for (; column > 0; column--) at = json_space(json_value(json_space(at + 1)));
  const char *verdict = json_member(json_space(at + 1), "verdict");
  cr_assert(verdict, "column %d", column);
  return verdict[1];
}

#endif
