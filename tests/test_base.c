/* src/base: words, memory, stores, the first failure of a team. */
#include "base/memory.h"
#include "base/store.h"
#include "base/team.h"
#include "base/threads.h"
#include "base/words.h"

#include <criterion/criterion.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

Test(words, differ_by_the_fewest_letters_to_insert_remove_or_replace_and_neighbours_to_swap)
{
  static const struct {
    const char *a, *b;
    size_t distance;
  } pairs[] = {{"", "", 0},         {"", "abc", 3},           {"wall", "wall", 0},
               {"wall", "ball", 1}, {"all", "wall", 1},       {"walls", "wall", 1},
               {"abc", "xyz", 3},   {"kitten", "sitting", 3}, {"sunday", "saturday", 3},
               {"ab", "ba", 1},     {"stpes", "steps", 1},    {"abcd", "badc", 2}};
  for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++) {
    cr_expect_eq(edit_distance(pairs[k].a, pairs[k].b), pairs[k].distance, "'%s', '%s'", pairs[k].a, pairs[k].b);
    cr_expect_eq(edit_distance(pairs[k].b, pairs[k].a), pairs[k].distance, "'%s', '%s'", pairs[k].b, pairs[k].a);
  }
}

Test(words, are_near_where_at_most_every_third_letter_differs)
{
  cr_expect(words_are_near("run", 1) && !words_are_near("run", 2));
  cr_expect(words_are_near("viscosty", 2) && !words_are_near("viscosty", 3));
  cr_expect(words_are_near("", 0) && !words_are_near("nu", 1));
}

Test(memory, is_zero_and_aligned_even_where_it_was_used_before)
{
  struct status status;
  for (size_t bytes = 1; bytes < 100000; bytes *= 3) {
    unsigned char *used = memory_allocate(bytes, 1, "a test", &status);
    cr_assert(used);
    memset(used, 0xff, bytes);
    free(used);
    const unsigned char *fresh = memory_allocate(bytes, 1, "a test", &status);
    cr_assert(fresh);
    cr_expect_eq((uintptr_t)fresh % CACHE_LINE, 0);
    for (size_t k = 0; k < bytes; k++) cr_assert_eq(fresh[k], 0, "byte %zu of %zu", k, bytes);
    free((void *)(uintptr_t)fresh);
  }
}

Test(memory, that_grows_keeps_its_content)
{
  struct status status;
  int *numbers = NULL;
  size_t capacity = 0;
  for (int k = 0; k < 1000; k++) {
    cr_assert(memory_grow(&numbers, &capacity, (size_t)k + 1, sizeof *numbers, "a test", &status));
    cr_assert_gt(capacity, (size_t)k);
    numbers[k] = k;
  }
  for (int k = 0; k < 1000; k++) cr_assert_eq(numbers[k], k);
  free(numbers);
}

Test(memory, beyond_what_there_is_is_refused_in_words)
{
  struct status status;
  cr_expect_not(memory_allocate(SIZE_MAX / 2, 4, "the moon", &status));
  cr_expect(status.code == DELBM_INVALID && status.out_of_memory && strstr(status.message, "for the moon"), "%s",
            status.message);
  cr_expect_not(memory_allocate(1, (size_t)(2 * memory_physical()), "the moon", &status));
}

Test(memory, in_use_counts_against_the_budget)
{
  struct status status;
  const size_t size = (size_t)64 << 20;
  const double before = memory_resident();
  void *used = memory_allocate(1, size, "a test", &status);
  cr_assert(used);
  cr_expect_geq(memory_resident(), before + 0.9 * (double)size);
  const size_t rest = (size_t)(memory_physical() - before - (double)size / 2);
  cr_expect_not(memory_map(rest, "the moon", &status));
  cr_expect(status.code == DELBM_INVALID && strstr(status.message, "for the moon beside "), "%s", status.message);
  free(used);
}

/* A store in memory. */
static struct store store_of(FILE *stream, bool saving)
{
  return (struct store){.stream = stream, .path = "a store", .saving = saving};
}

Test(store, sums_up_all_bytes_and_names_what_it_finds_in_place_of_a_mark)
{
  char bytes[64], words[] = "some words", read[sizeof words];
  struct status status;
  FILE *stream = fmemopen(bytes, sizeof bytes, "w+");
  struct store out = store_of(stream, true), in = store_of(stream, false);
  cr_assert(store_mark(&out, "first", &status) && store_bytes(&out, words, sizeof words, &status));
  rewind(stream);
  cr_expect_eq(out.sum, (uint32_t)crc32_z(0, (const void *)bytes, 16 + sizeof words));
  cr_assert(store_mark(&in, "first", &status) && store_bytes(&in, read, sizeof read, &status));
  cr_expect_str_eq(read, words);
  cr_expect_eq(in.sum, out.sum);
  rewind(stream);
  cr_expect_not(store_mark(&in, "second", &status));
  cr_expect_str_eq(status.message, "cannot read a store: second expected, 'first' found");
  fclose(stream);
}

Test(team, keeps_its_first_failure)
{
  struct status first, second;
  struct team team = {0};
  status_fail(&first, DELBM_FAILED, "first");
  status_fail(&second, DELBM_IO, "second");
  bool leave = true;
  team_decide(&team, &leave);
  cr_expect_not(leave);
  team_fail(&team, &first);
  team_fail(&team, &second);
  team_decide(&team, &leave);
  cr_expect(leave);
  cr_expect_eq(team.first.code, DELBM_FAILED);
  cr_expect_str_eq(team.first.message, "first");
}

Test(threads, are_as_many_as_4096_cells_each_keep_busy_and_no_more_than_asked_for)
{
  omp_set_num_threads(3);
  cr_expect_eq(threads_for(1), 1);
  cr_expect_eq(threads_for(8191), 1);
  cr_expect_eq(threads_for(8192), 2);
  cr_expect_eq(threads_for(1 << 20), 3);
}
