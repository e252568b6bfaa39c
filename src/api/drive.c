/* Discs driven by callbacks. A callback sets the velocity before the step, which then treats the disc as any driven
 * disc. The fluid inside the disc is accelerated, too; as for free discs (exchange.h), m_f dV is added to the force on
 * the solid. */
#include "api/drive.h"

#include "api/discs.h"
#include "base/memory.h"

static struct drive *find(struct delbm_simulation *s, size_t disc)
{
  for (size_t k = 0; k < s->drive_count; k++)
    if (s->drives[k].disc == disc) return &s->drives[k];
  return NULL;
}

static struct drive *add(struct delbm_simulation *s, size_t disc, struct status *status)
{
  if (!memory_grow(&s->drives, &s->drive_capacity, s->drive_count + 1, sizeof *s->drives, "the driven discs", status))
    return NULL;
  s->drives[s->drive_count] = (struct drive){.disc = disc};
  return &s->drives[s->drive_count++];
}

static bool set_drive(struct delbm_simulation *s, size_t disc, delbm_drive_function *function, void *context,
                      struct status *status)
{
  if (!api_has_discs(s, disc, 1, status)) return false;
  if (s->scene.particles.discs[disc].motion != DISC_DRIVEN)
    return status_fail(status, DELBM_USAGE, "disc %zu is not a driven one", disc);
  struct drive *drive = find(s, disc);
  if (!function) {
    if (drive) *drive = s->drives[--s->drive_count];
    return true;
  }
  if (!drive && !(drive = add(s, disc, status))) return false;
  drive->function = function;
  drive->context = context;
  return true;
}

enum delbm_code delbm_drive(struct delbm_simulation *s, size_t disc, delbm_drive_function *function, void *context,
                            struct delbm_status *out)
{
  struct api_call call;
  const bool good = api_enter(&call, s, out) && set_drive(s, disc, function, context, &call.status);
  return api_leave(&call, good);
}

/* Calls the callback of a disc in the caller's locale, and checks and stores the velocity and spin that it returns. */
static bool ask(const struct delbm_simulation *s, struct drive *drive, struct api_call *call)
{
  const struct delbm_disc_state now = api_disc_state(simulation_discs(s->simulation), drive->disc);
  double velocity[2] = {now.velocity[0], now.velocity[1]}, spin = now.spin;
  c_locale_leave(call->locale);
  drive->function(drive->context, simulation_step(s->simulation), &now, velocity, &spin);
  call->locale = c_locale_enter();
  if (!api_allows_motion(s, drive->disc, velocity, spin, &call->status)) return false;
  drive->wanted[0] = velocity[0];
  drive->wanted[1] = velocity[1];
  drive->wanted[2] = spin;
  return true;
}

static void set_motion(const struct discs *d, struct drive *drive)
{
  double *const motion[3] = {&d->vx[drive->disc], &d->vy[drive->disc], &d->omega[drive->disc]};
  for (int k = 0; k < 3; k++) {
    drive->change[k] = drive->wanted[k] - *motion[k];
    *motion[k] = drive->wanted[k];
  }
}

bool api_drive_begin(struct delbm_simulation *s, struct api_call *call)
{
  for (size_t k = 0; k < s->drive_count; k++)
    if (!ask(s, &s->drives[k], call)) return false;
  for (size_t k = 0; k < s->drive_count; k++) set_motion(simulation_discs(s->simulation), &s->drives[k]);
  return true;
}

void api_drive_end(struct delbm_simulation *s)
{
  const struct discs *d = simulation_discs(s->simulation);
  if (s->scene.coupling.solve != SOLVE_IMPLICIT) return;
  for (size_t k = 0; k < s->drive_count; k++) {
    const struct drive *drive = &s->drives[k];
    d->fx[drive->disc] += d->fluid_mass[drive->disc] * drive->change[0];
    d->fy[drive->disc] += d->fluid_mass[drive->disc] * drive->change[1];
    d->torque[drive->disc] += d->fluid_inertia[drive->disc] * drive->change[2];
  }
}
