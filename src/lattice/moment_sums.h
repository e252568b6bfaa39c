/* Sums over the cells of a disc, or of one of its rows (PHYSICS 2.1): with share s = w_p B, lever arm r and the moments of the
 * populations about to be collided. The force of the step, F = rho g + uniform, is not in them, since they are taken before
 * it is known; with sum s and sum s r they are all that it needs. */
#ifndef DELBM_LATTICE_MOMENT_SUMS_H
#define DELBM_LATTICE_MOMENT_SUMS_H

struct moment_sums {
  double jx, jy, torque;   /* sum s j, s (r x j) */
  double mass, mx, my, mm; /* sum s rho, s rho r, s rho |r|^2 */
  double share, sx, sy;    /* sum s, s r */
};

static inline void moment_sums_add(struct moment_sums *to, const struct moment_sums *from)
{
  to->jx += from->jx;
  to->jy += from->jy;
  to->torque += from->torque;
  to->mass += from->mass;
  to->mx += from->mx;
  to->my += from->my;
  to->mm += from->mm;
  to->share += from->share;
  to->sx += from->sx;
  to->sy += from->sy;
}

#endif
