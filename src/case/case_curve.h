/* case_curve.h -- distances between a curve that a run gave and a reference.  Knows no files and
 * no particles. */
#ifndef SPH_CASE_CURVE_H
#define SPH_CASE_CURVE_H
#include "sphode/base.h"

typedef struct sph_case_curve {
  long n;
  const double *x, *y; /* [n]; of a run: x rises */
} sph_case_curve;

typedef struct sph_case_distance {
  /* In: */
  const char *norm; /* "rms", "l1", "max", "mean", "arrival", "drift", "period", "decay" */
  double offset;    /* largest time offset t0; 0: none */
  double average;   /* width of the moving average of the run */
  double window[2]; /* x of the reference that count */
  double up_to;     /* largest y of the reference that counts */
  double threshold; /* of arrival */
  int by_time;      /* rms, l1: a point counts for the time it stands for, not once */
  double one; /* with reference n == 0: the one value (arrival, period: time; decay: 1/time) */
  /* Out: */
  double value;      /* at the best offset; NaN: the curves say nothing */
  double unshifted;  /* at offset 0 */
  double shift;      /* the best offset t0: run(x - t0) is compared with reference(x) */
  double found;      /* mean, arrival, drift, period, decay: that of the run; else NaN */
  double largest;    /* y of the reference that counts; arrival: its time */
  long used, wanted; /* points of the reference: compared; in the window */
} sph_case_distance;

/* 0 or SPH_ERR_MEMORY. */
int sph_case_curve_compare(const sph_case_curve *run, const sph_case_curve *reference,
                           sph_case_distance *distance, sph_error *error);
/* The mean of y over x - width/2 ... x + width/2, cut at the ends of the run; width 0: y at x,
 * before the first point the first y.  integral[n] as of sph_case_curve_integrate. */
double sph_case_curve_mean(const sph_case_curve *run, const double *integral, double x,
                           double width);
void sph_case_curve_integrate(const sph_case_curve *run, double *integral);
/* "rms", "l1", "max" of a[n] - b[n], weight[n] > 0 or NULL; NaN for n == 0. */
double sph_case_curve_norm(const char *norm, long n, const double *weight, const double *a,
                           const double *b);

enum { SPH_CASE_LABEL = 80 };
/* "density [kg/m^3]"; of what is drawn in a scale of its own "velocity / (1e-06 m/s)". */
void sph_case_curve_label(char label[SPH_CASE_LABEL], const char *what, double scale,
                          const char *unit);

/* Norms that are of a run alone, and compared with one number: drift, period, decay. */
int sph_case_curve_of_one(const char *norm);
/* Period and rate of decay of a run that swings around zero, inside the window, or rate of decay of
 * one without zeros; NaN: too few swings.  0 or SPH_ERR_MEMORY. */
int sph_case_swing(const sph_case_curve *run, const double window[2], double *period, double *rate,
                   sph_error *error);

#endif
