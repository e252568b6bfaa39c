/* What contacts leave to the next step: the account of each that has pressed, in the order in which contacts are listed:
 * pairs, then sides, each by a, then b. */
#ifndef DELBM_SIM_CONTACT_MEMORY_H
#define DELBM_SIM_CONTACT_MEMORY_H

#include "base/store.h"
#include "contact/account.h"

struct contact_memory {
  struct remembered *list;
  size_t count, capacity;
};

/* From this b on, a contact is with a side: with side b - contact_sides. */
static const uint32_t contact_sides = UINT32_MAX - 3;

void contact_memory_destroy(struct contact_memory *memory);

/* Saves or restores it; what is no memory of so many discs is refused. */
bool contact_memory_store(struct contact_memory *memory, size_t discs, struct store *store, struct status *status);

/* Room for so many. */
bool contact_memory_reserve(struct contact_memory *memory, size_t count, struct status *status);

/* Forgets all, and then remembers one after the other. */
void contact_memory_clear(struct contact_memory *memory);
void contact_memory_add(struct contact_memory *memory, uint32_t a, uint32_t b, const struct contact_account *account);

/* Where to begin to walk for contacts from (a, b) on. */
size_t contact_memory_seek(const struct contact_memory *memory, uint32_t a, uint32_t b);

/* The account of contact (a, b), which comes after those that were walked to before; NULL if there is none. */
const struct contact_account *contact_memory_walk(const struct contact_memory *memory, size_t *at, uint32_t a,
                                                  uint32_t b);

#endif
