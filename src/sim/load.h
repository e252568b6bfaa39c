/* Loads that contacts are expected to bear, from the scene at its start: at rest under gravity, and in an impact.
 *
 * At rest. In a pile, weight per width times 2 R of the disc with the largest load, on the smallest disc; of discs beside
 * each other, their own weight on the side, or of the heaviest on a smaller one; along a periodic axis, on which there is
 * no pile, own weight on the smallest disc.
 *
 * Impact. Kinetic energy m_eff v^2/2 of relative motion, m the mass of the disc and of the fluid inside R_h. v is
 * the largest relative speed of discs at rest, at their initial velocities and, under gravity, at the lesser of
 * terminal velocity (estimate_settling) and that of a free fall onto the pile. Drag on the way and damping are not subtracted.
 *
 * Force and energy of a contact are in proportion to its stiffness k_n, so that the stiffness for an overlap is a
 * quotient. */
#ifndef DELBM_SIM_LOAD_H
#define DELBM_SIM_LOAD_H

#include "sim/sediment.h"

/* A contact of two bodies; radius[1] = INFINITY: with a side. */
struct load {
  double radius[2];
  double force;  /* at rest */
  double energy; /* of an impact, in place of the force */
  double speed;  /* of the impact */
  double mass;   /* effective */
};

struct loads {
  struct load at_rest, impact; /* with force or energy 0: none */
};

/* Mass of a disc and of the fluid inside its hydraulic radius. */
double load_mass(const struct scene *scene, const struct disc_spec *disc);

struct loads loads_of(const struct scene *scene);

/* At rest in a sediment along an axis that is not periodic. */
struct load load_in_sediment(const struct scene *scene, const struct sediment *sediment);

/* k_n for an overlap of contact.overlap of the smaller radius; 0 without a load. */
double load_stiffness(const struct scene *scene, const struct load *load);

/* Overlap over the smaller radius, at contact.stiffness; at most 1. */
double load_overlap(const struct scene *scene, const struct load *load);

/* Contact sub-steps of a step at this overlap. */
int load_substeps(const struct scene *scene, const struct load *load);

/* k_n with which two bodies, at least one of them free, separate at the advised speed from an overlap in cells; `b` NULL: a
 * side. */
double load_parting_stiffness(const struct scene *scene, const struct disc_spec *a, const struct disc_spec *b,
                              double overlap);

/* Sets contact.stiffness for these loads: the larger of both stiffnesses, but as small as a fixed number of sub-steps or
 * area by cells, evaluated once a step, requires; at most `max`; at least load_min_stiffness. */
void load_set_stiffness(struct scene *scene, const struct loads *loads, double max);

/* The stiffness of the paper's cases, without a load. */
static const double load_min_stiffness = 0.25;

#endif
