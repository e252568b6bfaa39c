/* DIR/settling.csv and DIR/profile.csv, the series of settling (analysis.h). */
#ifndef DELBM_CLI_TABLES_H
#define DELBM_CLI_TABLES_H

#include "analysis/analysis.h"

bool tables_write(const struct settling *settling, const char *directory, struct status *status);

#endif
