/* The C locale for the calling thread: numbers with a decimal point and messages in English, whatever locale the process
 * has set. It is entered where a thread comes into our code, in main and in each call of the library, so that no code
 * inside has to think of it. Threads that OpenMP starts are in the locale of the process; the only numbers that they
 * print are those of a failure, for which status.c enters it, too. */
#ifndef DELBM_BASE_C_LOCALE_H
#define DELBM_BASE_C_LOCALE_H

#include <locale.h>

/* Returns the locale of the thread, to be passed to c_locale_leave. */
locale_t c_locale_enter(void);
void c_locale_leave(locale_t before);

#endif
