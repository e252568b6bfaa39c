/* Scenes to case files. */
#ifndef DELBM_SCENE_SCENE_WRITE_H
#define DELBM_SCENE_SCENE_WRITE_H

#include "scene/scene.h"

#include <stdio.h>

/* Writes the case with every default filled in; reading it gives the same scene, bit for bit. Discs of particles.fill
 * are left to be drawn again. False if writing failed. */
bool scene_write(const struct scene *scene, FILE *file);

#endif
