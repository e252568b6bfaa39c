#include "contact/state.h"

#include "base/memory.h"

#include <stdlib.h>

struct saved_state {
  uint32_t a, b;
  struct contact_state state;
};

static bool precedes(uint32_t a, uint32_t b, uint32_t next_a, uint32_t next_b)
{
  const bool side = b >= contact_sides, next_side = next_b >= contact_sides;
  if (side != next_side) return next_side;
  return a < next_a || (a == next_a && b < next_b);
}

void states_destroy(struct contact_states *s)
{
  free(s->list);
  *s = (struct contact_states){0};
}

bool states_reserve(struct contact_states *s, size_t count, struct status *status)
{
  return memory_grow(&s->list, &s->capacity, count, sizeof *s->list, "the contacts", status);
}

void states_clear(struct contact_states *s)
{
  s->count = 0;
}

void states_add(struct contact_states *s, uint32_t a, uint32_t b, const struct contact_state *state)
{
  s->list[s->count++] = (struct saved_state){a, b, *state};
}

const struct contact_state *states_next(const struct contact_states *s, size_t *at, uint32_t a, uint32_t b)
{
  while (*at < s->count && precedes(s->list[*at].a, s->list[*at].b, a, b)) ++*at;
  const bool found = *at < s->count && s->list[*at].a == a && s->list[*at].b == b;
  return found ? &s->list[*at].state : NULL;
}

static bool is_possible(const struct contact_states *s, size_t k, size_t discs)
{
  const struct saved_state *entry = &s->list[k];
  const struct contact_state *state = &entry->state;
  const bool in_order = k == 0 || precedes(s->list[k - 1].a, s->list[k - 1].b, entry->a, entry->b);
  const bool known = entry->a < discs && (entry->b >= contact_sides || (entry->a < entry->b && entry->b < discs));
  return in_order && known && state->stored >= 0 && state->impulse >= 0 && state->spring_impulse >= 0 &&
         state->shear_stiffness >= 0 && state->moment_stiffness >= 0 && isfinite(state->stored) &&
         isfinite(state->impulse) && isfinite(state->spring_impulse) && isfinite(state->approach_speed) &&
         isfinite(state->shear) && isfinite(state->shear_stiffness) && isfinite(state->moment) &&
         isfinite(state->moment_stiffness);
}

bool states_store(struct contact_states *s, size_t discs, struct store *store, struct status *status)
{
  uint64_t count = s->count;
  const double max = 0.5 * (double)discs * ((double)discs + 7); /* all pairs, and four sides per disc */
  if (!store_bytes(store, &count, sizeof count, status)) return false;
  if ((double)count > max)
    return status_fail(status, DELBM_IO, "cannot read %s: %llu contacts of %zu discs", store->path,
                       (unsigned long long)count, discs);
  if (!states_reserve(s, count, status)) return false;
  s->count = count;
  if (count > 0 && !store_bytes(store, s->list, count * sizeof *s->list, status)) return false;
  for (size_t k = 0; k < count && !store->saving; k++)
    if (!is_possible(s, k, discs))
      return status_fail(status, DELBM_IO, "cannot read %s: contact %zu, of %u and %u, is none that a run leaves",
                         store->path, k, s->list[k].a, s->list[k].b);
  return true;
}
