/* sphode/simd.h -- one vector type per translation unit: SPH_LANES doubles.
 *
 * SPH_LANES is a constant of the translation unit: 1 (the slow, plain reference), 2, 4 (AVX2), 8
 * (AVX-512).  Operators + - * / work on vec as on double, comparisons where it holds doubles; the
 * functions below do the rest.
 *
 * With SPH_SQRT_NEWTON roots of eight lanes are made by Newton's steps, beside the divider: a
 * fifth to a third faster on processors of Intel, slower on those of AMD.
 *
 * With SPH_VEC_FLOAT vec and vec_scalar are floats: the library's loops of mixed precision.
 *
 * With SPH_VEC_TANGENT vec is one complex number instead, a value and, tiny beside it, a
 * derivative (complex step; Martins, Sturdza & Alonso 2003): a body that uses the operators + - * /
 * and the functions below then differentiates itself, exactly to rounding.  Constants of a body
 * that it may be differentiated with respect to are vec_scalar. */
#ifndef SPHODE_SIMD_H
#define SPHODE_SIMD_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef SPH_VEC_TANGENT
#define SPH_LANES 1
#elif !defined(SPH_LANES)
#if defined(__AVX512F__)
#define SPH_LANES 8
#elif defined(__AVX__)
#define SPH_LANES 4
#else
#define SPH_LANES 2
#endif
#endif

#if defined(__AVX512F__) || defined(__AVX__) || defined(__SSE2__)
#include <immintrin.h>
#endif

#define BODY static inline __attribute__((always_inline, unused))

#ifdef SPH_VEC_TANGENT

typedef double _Complex vec, vec_scalar;
typedef double vec_number; /* what is loaded and stored */
typedef int vec_mask;

BODY vec v_set(vec_scalar a) { return a; }
BODY vec v_load(const double *a) { return *a; }
BODY vec v_gather(const double *a, long stride) { return a[0 * stride]; }
BODY void v_store(double *to, vec a) { *to = __real__ a; }
BODY vec_mask v_less(vec a, vec b) { return __real__ a < __real__ b; }
BODY vec v_and(vec_mask m, vec a) { return m ? a : 0; }
BODY vec v_select(vec_mask m, vec a, vec b) { return m ? a : b; }
BODY vec v_max(vec a, vec b) { return v_less(b, a) ? a : b; }
BODY vec v_min(vec a, vec b) { return v_less(a, b) ? a : b; }
BODY vec v_sqrt(vec a) /* without slope at 0: where products of derivatives are left alone */
{
  double root = __real__ a < 1e-150 ? 0 : sqrt(__real__ a);
  return __builtin_complex(root, root > 0 ? __imag__ a / (2 * root) : 0);
}

#else

#ifdef SPH_VEC_FLOAT
typedef float vec_scalar;
typedef int32_t vec_integer;
#else
typedef double vec_scalar; /* of a body's constants */
typedef int64_t vec_integer;
#endif
typedef vec_scalar vec_number; /* what is loaded and stored */
typedef vec_scalar vec __attribute__((vector_size(sizeof(vec_scalar) * SPH_LANES)));
typedef vec_integer vec_mask __attribute__((vector_size(sizeof(vec_scalar) * SPH_LANES)));

BODY vec v_set(vec_scalar a) { return a - (vec){0}; }
BODY vec v_load(const vec_scalar *a) /* unaligned */
{
  vec r;
  memcpy(&r, a, sizeof r);
  return r;
}
BODY vec v_gather(const vec_scalar *a, long stride) /* a[0], a[stride], a[2 stride], ... */
{
  vec r = {0};
  for (int l = 0; l < SPH_LANES; l++) r[l] = a[l * stride];
  return r;
}
BODY void v_store(vec_scalar *to, vec a) { memcpy(to, &a, sizeof a); }
BODY vec_mask v_less(vec a, vec b) { return (vec_mask)(a < b); }
BODY vec v_and(vec_mask m, vec a) { return (vec)(m & (vec_mask)a); }
BODY vec v_select(vec_mask m, vec a, vec b) /* m ? a : b */
{
  return (vec)((m & (vec_mask)a) | (~m & (vec_mask)b));
}

/* gcc makes a comparison and a mask of a conditional: real max/min instructions gain 4 to 18 %. */
#if defined(SPH_VEC_FLOAT) && SPH_LANES == 8 && defined(__AVX__)
BODY vec v_max(vec a, vec b) { return (vec)_mm256_max_ps((__m256)a, (__m256)b); }
BODY vec v_min(vec a, vec b) { return (vec)_mm256_min_ps((__m256)a, (__m256)b); }
BODY vec v_sqrt(vec a) { return (vec)_mm256_sqrt_ps((__m256)a); }
#elif SPH_LANES == 8 && defined(__AVX512F__)
BODY vec v_max(vec a, vec b) { return (vec)_mm512_max_pd((__m512d)a, (__m512d)b); }
BODY vec v_min(vec a, vec b) { return (vec)_mm512_min_pd((__m512d)a, (__m512d)b); }
#ifdef SPH_SQRT_NEWTON
BODY vec v_sqrt(vec a) /* 14 bits, twice as many a step: within an ulp or two; a < 1e300 */
{
  vec y = (vec)_mm512_rsqrt14_pd((__m512d)v_max(a, v_set(1e-300))), root = a * y, half = 0.5 * y;
  vec off = 0.5 - root * half;
  root += root * off, half += half * off;
  return root + (a - root * root) * half;
}
#else
BODY vec v_sqrt(vec a) { return (vec)_mm512_sqrt_pd((__m512d)a); }
#endif
#elif SPH_LANES == 4 && defined(__AVX__)
BODY vec v_max(vec a, vec b) { return (vec)_mm256_max_pd((__m256d)a, (__m256d)b); }
BODY vec v_min(vec a, vec b) { return (vec)_mm256_min_pd((__m256d)a, (__m256d)b); }
BODY vec v_sqrt(vec a) { return (vec)_mm256_sqrt_pd((__m256d)a); }
#elif SPH_LANES == 2 && defined(__SSE2__)
BODY vec v_max(vec a, vec b) { return (vec)_mm_max_pd((__m128d)a, (__m128d)b); }
BODY vec v_min(vec a, vec b) { return (vec)_mm_min_pd((__m128d)a, (__m128d)b); }
BODY vec v_sqrt(vec a) { return (vec)_mm_sqrt_pd((__m128d)a); }
#else
BODY vec v_max(vec a, vec b) { return v_select((vec_mask)(a > b), a, b); }
BODY vec v_min(vec a, vec b) { return v_select((vec_mask)(a < b), a, b); }
BODY vec v_sqrt(vec a)
{
  vec r;
  for (int l = 0; l < SPH_LANES; l++) r[l] = (vec_scalar)sqrt(a[l]);
  return r;
}
#endif

/* Bit l is set where lane l of the mask is. */
#if defined(SPH_VEC_FLOAT) && SPH_LANES == 8 && defined(__AVX__)
BODY unsigned v_bits(vec_mask m) { return (unsigned)_mm256_movemask_ps((__m256)m); }
#elif SPH_LANES == 8 && defined(__AVX512DQ__)
BODY unsigned v_bits(vec_mask m) { return _mm512_movepi64_mask((__m512i)m); }
#elif SPH_LANES == 4 && defined(__AVX__)
BODY unsigned v_bits(vec_mask m) { return (unsigned)_mm256_movemask_pd((__m256d)m); }
#elif SPH_LANES == 2 && defined(__SSE2__)
BODY unsigned v_bits(vec_mask m) { return (unsigned)_mm_movemask_pd((__m128d)m); }
#else
BODY unsigned v_bits(vec_mask m)
{
  unsigned bits = 0;
  for (int l = 0; l < SPH_LANES; l++) bits |= (unsigned)(m[l] != 0) << l;
  return bits;
}
#endif

#endif /* SPH_VEC_TANGENT */

/* What a particle's distance from itself is divided by; the square of it is not zero. */
#ifdef SPH_VEC_FLOAT
BODY vec v_tiny(void) { return v_set(1e-15f); }
#else
BODY vec v_tiny(void) { return v_set(1e-150); }
#endif

BODY vec v_max0(vec a) { return v_max(a, v_set(0)); }
BODY vec v_min0(vec a) { return v_min(a, v_set(0)); }
BODY vec v_abs(vec a) { return v_max(a, -a); }

#endif
