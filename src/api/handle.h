/* What is behind the public handle, and how its calls report. */
#ifndef DELBM_API_HANDLE_H
#define DELBM_API_HANDLE_H

#include "delbm/delbm.h"
#include "scene/scene_errors.h"
#include "sim/simulation.h"

/* A disc that a callback drives. */
struct drive {
  size_t disc;
  delbm_drive_function *function;
  void *context;
  double change[3]; /* of velocity and spin, at the present step */
};

struct delbm_simulation {
  struct scene scene;
  struct simulation *simulation;
  uint32_t fingerprint; /* of the scene */
  struct drive *drives; /* [drive_count], by disc */
  size_t drive_count, drive_capacity;
};

/* Hands an outcome to the caller: the code of *status if not `good`. `out` may be NULL. */
enum delbm_code api_success(struct delbm_status *out);
enum delbm_code api_result(bool good, const struct status *status, struct delbm_status *out);

/* The same for a case with errors, if there are any: as many of them as there is room for. */
enum delbm_code api_case_result(bool good, const struct status *status, const struct scene_errors *errors,
                                struct delbm_status *out);

/* Fails unless first .. first + count - 1 are discs. */
bool api_has_discs(const struct delbm_simulation *simulation, size_t first, size_t count, struct status *status);

/* Fails unless the disc may have this velocity and spin. */
bool api_allows_motion(const struct delbm_simulation *simulation, size_t disc, const double velocity[2], double spin,
                       struct status *status);

/* The disc as it is now. */
struct delbm_disc_state api_disc_state(const struct discs *discs, size_t disc);

/* Before a step and after it: asks the callbacks and sets what they ask for; makes the forces whole. */
bool api_drive_begin(struct delbm_simulation *simulation, struct status *status);
void api_drive_end(struct delbm_simulation *simulation);

#endif
