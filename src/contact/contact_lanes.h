/* The near entries of a block of the contact table, in vectors: the working memory of contact_block.c, which is compiled once
 * per instruction set. */
#ifndef DELBM_CONTACT_CONTACT_LANES_H
#define DELBM_CONTACT_CONTACT_LANES_H

#include "base/variant.h"
#include "contact/contact_kernel.h"

enum { BLOCK = CONTACT_BLOCK };

struct lanes {
  int count, n; /* entries; the same in whole vectors */
  bool sides;
  uint8_t entry[BLOCK]; /* counted from the first of the block */
  struct body_pairs pairs;
  struct body_overlaps overlaps;
  double strength[BLOCK], damper[BLOCK], inverse_mass[BLOCK], touch[BLOCK];
  double vx[BLOCK], vy[BLOCK], ax[BLOCK], ay[BLOCK]; /* relative velocity, relative change of velocity by dV */
  double xx[BLOCK], xy[BLOCK], yy[BLOCK];            /* sum of both K */
  double omega[2][BLOCK], domega[2][BLOCK], xw[2][BLOCK], yw[2][BLOCK], ww[2][BLOCK]; /* if torques count */
  double approach[BLOCK], compliance[BLOCK], mean[BLOCK];
  double stiffness[BLOCK], eta[BLOCK];
  double moved[BLOCK];                 /* time since the last sub-step, or since the contact began */
  double spring[BLOCK], normal[BLOCK]; /* impulses: of the spring alone, and J_n */
};

#endif
