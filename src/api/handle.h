/* The public handle, and start and end of its calls. */
#ifndef DELBM_API_HANDLE_H
#define DELBM_API_HANDLE_H

#include "base/c_locale.h"
#include "case/case_errors.h"
#include "delbm/delbm.h"
#include "sim/simulation.h"

/* A disc that a callback drives. */
struct drive {
  size_t disc;
  delbm_drive_function *function;
  void *context;
  double wanted[3], change[3]; /* velocity and spin in the present step, and their change from the previous step */
};

struct delbm_simulation {
  struct scene scene;
  struct simulation *simulation;
  uint32_t fingerprint; /* of the scene */
  struct drive *drives; /* [drive_count], by disc */
  size_t drive_count, drive_capacity;
  bool lost; /* a failed call has changed the state: the handle can only be closed */
};

/* A call of the library in progress. */
struct api_call {
  struct delbm_status *out; /* of the caller; may be NULL */
  locale_t locale;          /* of the caller */
  struct status status;
};

/* Begins a call and enters the C locale. False if the simulation (may be NULL) can only be closed. */
bool api_enter(struct api_call *call, const struct delbm_simulation *simulation, struct delbm_status *out);

/* Ends a call, and returns its code and message to the caller: of call->status if not `good`. */
enum delbm_code api_leave(struct api_call *call, bool good);

/* api_leave with the errors of a case as message, as many as fit. */
enum delbm_code api_leave_case(struct api_call *call, bool good, const struct case_errors *errors);

#endif
