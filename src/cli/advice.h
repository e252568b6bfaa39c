/* Warnings about a case from the maps of `delbm bench stability` (bench/STABILITY.md), each with a remedy. */
#ifndef DELBM_CLI_ADVICE_H
#define DELBM_CLI_ADVICE_H

#include "model/scene.h"

/* Prints the warnings that apply. */
void print_advice(const struct scene *scene);

/* Parts of print_advice: sound near the frequency of shedding; discs that come to rest. */
void advise_sound(const struct scene *scene);
void advise_rest(const struct scene *scene);

#endif
