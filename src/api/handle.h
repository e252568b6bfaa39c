/* What is behind the public handle, and how its calls report. */
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
  double wanted[3], change[3]; /* velocity and spin of the present step, and how they differ from those before it */
};

struct delbm_simulation {
  struct scene scene;
  struct simulation *simulation;
  uint32_t fingerprint; /* of the scene */
  struct drive *drives; /* [drive_count], by disc */
  size_t drive_count, drive_capacity;
  bool lost; /* a call has failed that could not leave the state as it was */
};

/* A call of the library between its first line and its last. */
struct api_call {
  struct delbm_status *out; /* of the caller; may be NULL */
  locale_t locale;          /* of the caller */
  struct status status;
};

/* Begins a call: in the C locale from here on. False if the simulation, which may be NULL, can only be closed. */
bool api_enter(struct api_call *call, const struct delbm_simulation *simulation, struct delbm_status *out);

/* Ends it and hands its outcome to the caller: the code of call->status if not `good`. */
enum delbm_code api_leave(struct api_call *call, bool good);

/* The same for a case with errors, if there are any: as many of them as there is room for. */
enum delbm_code api_leave_case(struct api_call *call, bool good, const struct case_errors *errors);

#endif
