/* failing.h -- makes one allocation of the library fail: link with $(failing_ldflags). */
#ifndef FAILING_H
#define FAILING_H

extern long fail_at; /* the call that fails, from 1; 0: none does */
extern long calls;   /* allocations asked for so far */

#endif
