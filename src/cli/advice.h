/* What the maps of `delbm bench stability` (bench/STABILITY.md) say about a case: warnings, each with what to do instead. */
#ifndef DELBM_CLI_ADVICE_H
#define DELBM_CLI_ADVICE_H

#include "model/scene.h"

/* Prints nothing where nothing is to be said. */
void print_advice(const struct scene *scene);

/* Its parts in files of their own: sound near the frequency of shedding; discs that come to rest. */
void advise_sound(const struct scene *scene);
void advise_rest(const struct scene *scene);

#endif
