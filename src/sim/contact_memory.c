#include "sim/contact_memory.h"

#include "base/memory.h"

#include <stdlib.h>

struct remembered {
  uint32_t a, b;
  struct contact_account account;
};

static bool precedes(uint32_t a, uint32_t b, uint32_t next_a, uint32_t next_b)
{
  const bool side = b >= contact_sides, next_side = next_b >= contact_sides;
  if (side != next_side) return next_side;
  return a < next_a || (a == next_a && b < next_b);
}

void contact_memory_destroy(struct contact_memory *m)
{
  free(m->list);
  *m = (struct contact_memory){0};
}

bool contact_memory_reserve(struct contact_memory *m, size_t count, struct status *status)
{
  return memory_grow(&m->list, &m->capacity, count, sizeof *m->list, "the contacts", status);
}

void contact_memory_clear(struct contact_memory *m)
{
  m->count = 0;
}

void contact_memory_add(struct contact_memory *m, uint32_t a, uint32_t b, const struct contact_account *account)
{
  m->list[m->count++] = (struct remembered){a, b, *account};
}

size_t contact_memory_seek(const struct contact_memory *m, uint32_t a, uint32_t b)
{
  size_t low = 0, end = m->count;
  while (low < end) {
    const size_t middle = low + (end - low) / 2;
    if (precedes(m->list[middle].a, m->list[middle].b, a, b))
      low = middle + 1;
    else
      end = middle;
  }
  return low;
}

const struct contact_account *contact_memory_walk(const struct contact_memory *m, size_t *at, uint32_t a, uint32_t b)
{
  while (*at < m->count && precedes(m->list[*at].a, m->list[*at].b, a, b)) ++*at;
  const bool found = *at < m->count && m->list[*at].a == a && m->list[*at].b == b;
  return found ? &m->list[*at].account : NULL;
}

static bool is_sane(const struct contact_memory *m, size_t k, size_t discs)
{
  const struct remembered *r = &m->list[k];
  const bool in_order = k == 0 || precedes(m->list[k - 1].a, m->list[k - 1].b, r->a, r->b);
  const bool known = r->a < discs && (r->b >= contact_sides || (r->a < r->b && r->b < discs));
  return in_order && known && account_is_sane(&r->account);
}

bool contact_memory_store(struct contact_memory *m, size_t discs, struct store *store, struct status *status)
{
  uint64_t count = m->count;
  const double most = 0.5 * (double)discs * ((double)discs + 7); /* all pairs, and four sides each */
  if (!store_bytes(store, &count, sizeof count, status)) return false;
  if ((double)count > most)
    return status_fail(status, DELBM_IO, "cannot read %s: %llu contacts of %zu discs", store->path,
                       (unsigned long long)count, discs);
  if (!contact_memory_reserve(m, count, status)) return false;
  m->count = count;
  if (count > 0 && !store_bytes(store, m->list, count * sizeof *m->list, status)) return false;
  for (size_t k = 0; k < count && !store->saving; k++)
    if (!is_sane(m, k, discs))
      return status_fail(status, DELBM_IO, "cannot read %s: contact %zu, of %u and %u, is none that a run leaves",
                         store->path, k, m->list[k].a, m->list[k].b);
  return true;
}
