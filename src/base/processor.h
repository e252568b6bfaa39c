/* Instruction sets of this processor, among the targets of the kernels. */
#ifndef DELBM_BASE_PROCESSOR_H
#define DELBM_BASE_PROCESSOR_H

#include <stdbool.h>

bool processor_has_avx2(void);   /* and FMA */
bool processor_has_avx512(void); /* F, DQ, VL and BW */

#endif
