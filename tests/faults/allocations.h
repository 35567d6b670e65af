/* Every allocation of the program counted, and made to fail: malloc and its kin are defined here, so they stand before
 * those of the C library for the program and for every shared library in it. operator new comes through malloc. */
#ifndef FOCAL_TEST_ALLOCATIONS_H
#define FOCAL_TEST_ALLOCATIONS_H

#include <stdint.h>

/* What is allocated now, and the most bytes since allocations_mark_peak. */
int64_t allocations_live_blocks(void);
int64_t allocations_live_bytes(void);
int64_t allocations_peak_bytes(void);
void allocations_mark_peak(void);

/* From here on allocations are counted from 1; number `first` fails, and with `ever` all after it. 0: none fails. */
void allocations_fail(int64_t first, int ever);
void allocation_refused(void);
/* Ends it; returns how many were asked for since. */
int64_t allocations_spare(void);

/* Around what a test itself needs inside. */
void allocations_pause(void);
void allocations_resume(void);

/* Makes every pthread_create after the first `count` fail with EAGAIN; -1: none. */
void threads_fail_after(int64_t count);

#endif
