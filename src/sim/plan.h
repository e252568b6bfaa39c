/* The plan: which stages of the step a scene needs. What it does not need is neither run nor allocated. */
#ifndef DELBM_SIM_PLAN_H
#define DELBM_SIM_PLAN_H

#include "scene/scene.h"

enum occupation_plan { OCCUPATION_NEVER, OCCUPATION_ONCE, OCCUPATION_EVERY_STEP };

struct plan {
  enum occupation_plan occupation;
  bool exchange; /* there are discs */
  bool pairs;    /* two discs, one of them moving, can meet */
  bool walls;    /* a free disc can meet a side */
  bool substeps; /* contacts may be stiff enough to need several sub-steps */
  bool force;    /* the kernel with a body force */
  int reach;     /* occupation_create's */
};

struct plan plan_of(const struct scene *scene);

/* Sub-steps that a contact of this stiffness (force per overlap distance), damping and inverse mass of relative motion
 * needs. */
int plan_substeps(const struct scene *scene, double stiffness, double damping, double inverse_mass);

/* The most sub-steps that any two of the scene's discs would take at an overlap of one cell. */
int plan_largest_substeps(const struct scene *scene);

#endif
