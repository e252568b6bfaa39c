/* The C locale for the calling thread: numbers with a decimal point and messages in English, whatever locale the
 * process has set. main and each call of the library enter it, so that all other code may assume it. Threads that
 * OpenMP starts are in the locale of the process; they print numbers in messages of failures alone, for which status.c
 * enters the C locale. */
#ifndef DELBM_BASE_C_LOCALE_H
#define DELBM_BASE_C_LOCALE_H

#include <locale.h>

/* Returns the previous locale of the thread, the argument of c_locale_leave. */
locale_t c_locale_enter(void);
void c_locale_leave(locale_t before);

#endif
