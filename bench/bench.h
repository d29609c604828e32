/* bench.h -- the benchmark's harness: figures by name, as a table or as JSON lines. */
#ifndef BENCH_H
#define BENCH_H

/* Seconds of this thread's CPU. */
double bench_thread_seconds(void);
/* Is a figure of that name asked for (--filter)? */
int bench_wanted(const char *name);
/* Is there a filter?  What takes long runs only when asked for. */
int bench_filtered(void);
/* One figure: median of values[n], with its spread (max - min)/median. */
void bench_report(const char *name, const char *unit, double *values, int n);
/* ... and the median of its ratios[n] to another, which was measured by turns with it. */
void bench_report_over(const char *name, const char *unit, double *values, int n,
                       const char *baseline, double *ratios);
int bench_quick(void); /* --quick: small sizes */
/* Says it on stderr; the program then fails in the end. */
void bench_complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

void bench_memory(void);      /* bytes a particle, by parts */
void bench_neighbors(void);   /* sort and list build */
void bench_search(void);      /* grid, hash, tree on uneven points; with --filter only */
void bench_rhs(void);         /* right-hand sides */
void bench_baseline(void);    /* the same over a good plain code; growth with size */
void bench_dam(void);         /* SPHERIC's test 2, a developed flow; with --filter only */
void bench_phases(void);      /* phases of right-hand sides, operations of vectors */
void bench_threads(void);     /* threads over one; with --filter only */
void bench_reach(void);       /* physical time per evaluation; with --filter only */
void bench_operators(void);   /* operators on points */
void bench_output(void);      /* frames of output beside steps; with --filter only */
void bench_tiles(void);       /* registered pair terms against fused ones */
void bench_stability(void);   /* stability limits of the integrators; with --filter only */
void bench_imex(void);        /* implicit-explicit integrators; with --filter only */
void bench_linear(void);      /* linear solvers; with --filter only */
void bench_multirate(void);   /* parts, stabilised schemes, relaxation; with --filter only */
void bench_derivatives(void); /* products with the Jacobian */
void bench_integration(void); /* time integration around the right-hand side */

#endif
