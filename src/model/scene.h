/* The scene: the case in memory, with every default filled in. Lattice units (dx = dt = 1, reference density 1).
 * Nothing here depends on the format of a case (src/case) or on its execution (src/sim). */
#ifndef DELBM_MODEL_SCENE_H
#define DELBM_MODEL_SCENE_H

#include "base/status.h"
#include "lattice/units.h"

#include <stddef.h>
#include <stdint.h>

/* Upper bound of prescribed speeds of fluid and of a disc's rim, Mach 0.52; cells/step. */
static const double scene_max_speed = 0.3;

/* Advised upper bound, Mach 0.17: errors of compressibility grow with the square of the Mach number. cells/step. */
static const double scene_advised_speed = 0.1;

enum side_name { SIDE_LEFT, SIDE_RIGHT, SIDE_BOTTOM, SIDE_TOP, SIDE_COUNT };
enum side_type { SIDE_WALL, SIDE_PERIODIC, SIDE_INLET, SIDE_OUTLET, SIDE_SLIP };
enum collision { COLLISION_BGK, COLLISION_TRT, COLLISION_MRT, COLLISION_ADAPTIVE };
enum precision { PRECISION_DOUBLE, PRECISION_SINGLE };
enum coupling_form { FORM_UNIFIED, FORM_OWEN, FORM_MIDPOINT, FORM_COUNT };
enum coupling_solve { SOLVE_IMPLICIT, SOLVE_EXPLICIT_AVERAGED };
enum contact_area { AREA_LENS, AREA_CELLS };
enum contact_search { SEARCH_GRID, SEARCH_LINKED_CELL };
enum contact_damping { DAMPING_CRITICAL, DAMPING_PRINTED };
/* Where contact.stiffness is from: the case; or `auto`, by the load at rest or in impacts, lowered for overlaps at the
 * start or for the number of sub-steps, or raised to the least value. */
enum stiffness_source {
  STIFFNESS_GIVEN,
  STIFFNESS_AT_REST,
  STIFFNESS_IMPACT,
  STIFFNESS_START,
  STIFFNESS_SUBSTEPS,
  STIFFNESS_LEAST
};
enum frame_quantity { FRAME_SPEED, FRAME_VORTICITY };
enum frame_discs { FRAME_DISCS_PLAIN, FRAME_DISCS_HEIGHT, FRAME_DISCS_SPEED, FRAME_DISCS_RADIUS };

/* One side of the box. `velocity` is the velocity of a wall along itself, or of the fluid at an inlet. */
struct side {
  enum side_type type;
  double velocity[2];
};

enum disc_motion {
  DISC_FREE,  /* by the forces on it */
  DISC_FIXED, /* stays in place; may spin at a prescribed rate */
  DISC_DRIVEN /* moves with its prescribed velocity and spin */
};

struct disc_spec {
  double radius;
  double density;
  double position[2];
  double velocity[2];
  double angle; /* radians, counter-clockwise */
  double spin;  /* radians a step, counter-clockwise */
  enum disc_motion motion;
};

/* Area of the disc, of its radius R. */
double disc_spec_area(const struct disc_spec *disc);

/* Discs on a square grid, each displaced by up to `jitter` cells in x and in y. */
struct fill_spec {
  bool present;
  double spacing;
  double radius;
  double density;
  double jitter;
  double region[4]; /* x0, y0, x1, y1 */
  uint64_t seed;
};

/* Relaxation rates of the collision, (3) of the paper with s_e = s_eps. */
struct rates {
  double s_nu; /* of pxx and pxy: 1/(3 viscosity + 1/2) */
  double s_e;  /* of e and eps */
  double s_q;  /* of qx and qy where fluid is at rest, or everywhere */
  double
      s_q_fast; /* of qx and qy far above the speed viscosity/cell, the mean of both at that speed; 0: s_q everywhere */
};

struct scene {
  char *title;
  char *name; /* of the case: the folder's or the file's, for the default output directory */

  struct units units; /* the lattice in SI; dx = 0: unknown */

  struct {
    int size[2];
    struct side side[SIDE_COUNT];
  } domain;

  struct {
    bool none; /* dry discs without a lattice: the other members, coupling and output.fields have no meaning */
    double viscosity;
    double force[2]; /* per unit mass */
    enum collision collision;
    struct rates rates;
    double magic; /* magic parameter of trt and adaptive, which determines s_q; 0: s_q is given */
    enum precision precision;
    bool zero_flux;
    char *kernel; /* forced kernel variant, or NULL for the best that the machine runs */
  } fluid;

  struct {
    enum coupling_form form;
    enum coupling_solve solve;
    double hydraulic_radius; /* R_h/R */
  } coupling;

  struct {
    double gravity[2];
    struct fill_spec fill;
    size_t count;            /* the listed discs, then the discs of `fill` */
    size_t listed;           /* discs listed one by one */
    struct disc_spec *discs; /* [count] */
  } particles;

  struct {
    unsigned law; /* enum contact_spring_law of contact/law_spring.h */
    enum contact_area area;
    enum contact_search search;
    double edge; /* of the linked cells; 0: one diameter */
    double stiffness;
    enum stiffness_source stiffness_source;
    double overlap;     /* of the smaller radius, under the expected load, for `auto` */
    double alpha;       /* 0: of the radii of each pair */
    double damping;     /* damping ratio */
    double restitution; /* 0: given by the damping ratio */
    double friction, tangential_ratio, rolling_friction;
    struct {
      double cutoff;    /* gap, cells; 0: none */
      double least_gap; /* part of the smaller radius */
    } lubrication;
    enum contact_damping damping_form;
    int substeps;             /* fixed number of sub-steps a step, 0: chosen from the stiffness */
    double steps_per_contact; /* target of that choice */
  } contact;

  struct {
    int64_t steps;
    int check; /* steps between two checks for divergence, 1 to 100 */
    struct {
      int depth; /* steps in a block of the sweep, 0: chosen by measurement */
      int width; /* cells of its tiles, 0: whole rows */
    } plan;
  } run;

  struct {
    int64_t every; /* steps between rows of particles.csv; 0: none */
    struct {
      int64_t every; /* 0: none */
    } series;
    struct {
      int64_t every; /* 0: only when interrupted */
    } checkpoint;
    struct {
      int64_t every;    /* 0: none */
      double region[4]; /* x0, y0, x1, y1: whole numbers */
      int stride;
    } fields;
    struct {
      int64_t every; /* 0: none */
      enum frame_quantity quantity;
      double maximum; /* value at the end of the colour scale; 0: the largest of each frame */
      enum frame_discs discs;
    } frames;
  } output;
};

/* Frees the members, not the struct itself. */
void scene_clear(struct scene *scene);

/* R_h of a disc, its radius for the fluid. */
static inline double scene_hydraulic_radius(const struct scene *scene, const struct disc_spec *disc)
{
  return scene->coupling.hydraulic_radius * disc->radius;
}

/* Mean radius of the discs; at least one. */
double scene_mean_radius(const struct scene *scene);

/* Appends the discs of particles.fill to the listed ones, drawing the displacements from GSL's generator mt19937 with
 * the case's seed: row by row from the lower left, x before y. */
bool scene_fill(struct scene *scene, struct status *status);

/* Density of a disc less that of the fluid which it displaces. */
static inline double scene_buoyant_density(const struct scene *scene, const struct disc_spec *disc)
{
  return scene->fluid.none ? disc->density : disc->density - 1;
}

/* Relaxation rate of the stress for a kinematic viscosity. */
static inline double rate_from_viscosity(double viscosity)
{
  return 1.0 / (3.0 * viscosity + 0.5);
}

/* Rate s_q for which (1/s_q - 1/2)(1/s_nu - 1/2) = magic. */
static inline double rate_from_magic(double magic, double viscosity)
{
  return 1.0 / (0.5 + magic / (3.0 * viscosity));
}

/* What a kind of side is to everything but the sweep (fluid/side_rules.c has its rule for links). */
struct side_kind {
  const char *name; /* in messages */
  bool closed;      /* no fluid passes */
  bool sticks;      /* the fluid beside it has the side's own velocity along it */
  enum { VELOCITY_NONE, VELOCITY_ALONG, VELOCITY_INTO } velocity; /* that may be given */
};
const struct side_kind *side_kind_of(enum side_type type);

/* As in the keys of a case. */
static inline const char *side_name_text(enum side_name side)
{
  static const char *const names[SIDE_COUNT] = {
      [SIDE_LEFT] = "left", [SIDE_RIGHT] = "right", [SIDE_BOTTOM] = "bottom", [SIDE_TOP] = "top"};
  return names[side];
}

/* The axis that a side bounds, and whether at its upper end. */
static inline int side_axis(enum side_name side)
{
  return side == SIDE_BOTTOM || side == SIDE_TOP;
}

static inline bool side_is_high(enum side_name side)
{
  return side == SIDE_RIGHT || side == SIDE_TOP;
}

/* From a place in the box to the side. */
static inline double scene_distance_to_side(const struct scene *scene, enum side_name side, const double place[2])
{
  const int axis = side_axis(side);
  return side_is_high(side) ? scene->domain.size[axis] - place[axis] : place[axis];
}

static inline bool scene_is_periodic(const struct scene *scene, int axis)
{
  return scene->domain.side[axis == 0 ? SIDE_LEFT : SIDE_BOTTOM].type == SIDE_PERIODIC;
}

static inline int64_t scene_cells(const struct scene *scene)
{
  return (int64_t)scene->domain.size[0] * scene->domain.size[1];
}

/* Of the two sides of an axis: are both closed, so that its mean volume flux is zero? How many stick? */
static inline bool scene_is_closed(const struct scene *scene, int axis)
{
  const struct side *sides = &scene->domain.side[axis == 0 ? SIDE_LEFT : SIDE_BOTTOM];
  return side_kind_of(sides[0].type)->closed && side_kind_of(sides[1].type)->closed;
}

static inline int scene_sticking_sides(const struct scene *scene, int axis)
{
  const struct side *sides = &scene->domain.side[axis == 0 ? SIDE_LEFT : SIDE_BOTTOM];
  return side_kind_of(sides[0].type)->sticks + side_kind_of(sides[1].type)->sticks;
}

#endif
