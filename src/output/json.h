#ifndef DELBM_OUTPUT_JSON_H
#define DELBM_OUTPUT_JSON_H

#include <stdio.h>

/* Writes a JSON string. A byte that is not UTF-8 (possible in a path) becomes the replacement character. */
void json_text(const char *text, FILE *stream);

#endif
