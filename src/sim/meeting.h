/* How two discs, or a disc and a side, meet: their overlap, and how they answer an impulse between them. */
#ifndef DELBM_SIM_MEETING_H
#define DELBM_SIM_MEETING_H

#include "coupling/exchange.h"
#include "sim/contact_memory.h"
#include "solid/lens.h"

struct contact {
  uint32_t a, b;       /* discs; b from contact_sides on: a side */
  double inverse_mass; /* 1/m_a + 1/m_b; 0: nothing to do */
  double damping;      /* eta */
  double cells_area;
  double small;             /* of its lens, see lens_small */
  double touch;             /* area by cells, in sub-steps: the distance at which it ends; else 0 */
  struct wrench on_a, on_b; /* impulse in this sub-step; on_b stays 0 with a side */
  struct contact_account account;
};

static inline bool contact_is_with_side(const struct contact *c)
{
  return c->b >= contact_sides;
}

/* Where discs are within a step: [disc]. */
struct places {
  double *x, *y, *vx, *vy, *omega;
};

struct meeting {
  struct lens lens; /* with the area that counts, and its own chord */
  double distance;  /* of centres, or of the centre from the side */
  double nx, ny;    /* the normal, from a to what it meets */
  double arm[2];    /* from a, and from b, to the contact point: where the normal crosses the lens's chord */
  double closing;   /* speed of approach */
};

struct meeting meeting_of(const struct scene *scene, const struct discs *discs, const struct contact *contact,
                          const struct places *at);

/* Inverse mass of the relative motion along the normal, that of the fluid that follows included: what the response says. */
double meeting_compliance(const struct meeting *meeting, const struct contact *contact, const struct exchange *e);

/* The speed of approach that is gained in a step without contacts. */
double meeting_gain(const struct meeting *meeting, const struct contact *contact, const struct exchange *e);

double distance_to_side(const struct scene *scene, enum side_name side, double x, double y);

#endif
