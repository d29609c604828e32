/* Binary data are a length and so many bytes; compressed ones the number of blocks, the length of
 * a block and of the last one, the lengths of all as they are compressed, and the blocks. */
#include "vtu_array.h"

#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "config.h"
#include "memory.h"

#ifdef SPH_HAVE_VTU
#include <zlib.h>

typedef struct source {
  const sph_vtu_head *head;
  const char *at;
  size_t left; /* bytes of the file from at on */
  int base64;
  sph_error *error;
} source;

static const struct {
  const char *name;
  size_t size;
} types[] = {{"Int8", 1},   {"UInt8", 1}, {"Int16", 2},  {"UInt16", 2},  {"Int32", 4},
             {"UInt32", 4}, {"Int64", 8}, {"UInt64", 8}, {"Float32", 4}, {"Float64", 8}};
enum { INT8, UINT8, INT16, UINT16, INT32, UINT32, INT64, UINT64, FLOAT32, FLOAT64, TYPES };

const char *sph_vtu_array_type_name(int type)
{
  return type >= 0 && type < TYPES ? types[type].name : NULL;
}

int sph_vtu_array_type(const char *name)
{
  for (int k = 0; k < TYPES; k++)
    if (!strcmp(types[k].name, name)) return k;
  return -1;
}

static int ends_early(const source *s)
{
  return sph_error_set(s->error, SPH_ERR_FILE, "the data end too early");
}

/* ---- bytes ---- */

static int digit(char c)
{
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* Bytes `from` to from + n of what is encoded here as one. */
static int copy(const source *s, size_t from, void *to, size_t n)
{
  unsigned char *byte = to;
  if (n > s->left || from > s->left - n) return ends_early(s);
  if (!s->base64) memcpy(to, s->at + from, n);
  for (size_t k = from; s->base64 && k < from + n; k++) {
    const size_t c = k / 3 * 4 + k % 3, shift = 2 * (k % 3);
    if (c + 1 >= s->left) return ends_early(s);
    const int a = digit(s->at[c]), b = digit(s->at[c + 1]);
    if (a < 0 || b < 0)
      return sph_error_set(s->error, SPH_ERR_FILE,
                           "byte 0x%02x is neither base64 nor the end of the data",
                           (unsigned char)s->at[a < 0 ? c : c + 1]);
    *byte++ = (unsigned char)((unsigned)a << (2 + shift) | (unsigned)b >> (4 - shift));
  }
  return SPH_OK;
}

static void swap(unsigned char *byte, size_t n)
{
  for (size_t k = 0; k < n / 2; k++) {
    const unsigned char kept = byte[k];
    byte[k] = byte[n - 1 - k], byte[n - 1 - k] = kept;
  }
}

static size_t word(const source *s) { return s->head->wide ? 8 : 4; }

/* The length number k of those that stand here. */
static int length(const source *s, size_t k, uint64_t *value)
{
  unsigned char byte[8];
  uint32_t narrow;
  int status = copy(s, k * word(s), byte, word(s));
  if (status) return status;
  if (s->head->swap) swap(byte, word(s));
  memcpy(&narrow, byte, sizeof narrow);
  *value = narrow;
  if (s->head->wide) memcpy(value, byte, sizeof *value);
  return SPH_OK;
}

/* ---- arrays of bytes ---- */

static int other_length(const source *s, uint64_t found, size_t right)
{
  return sph_error_set(s->error, SPH_ERR_FILE, "%llu bytes where %zu would be right",
                       (unsigned long long)found, right);
}

static int plain(const source *s, unsigned char *to, size_t bytes)
{
  uint64_t given = 0;
  int status = length(s, 0, &given);
  if (!status && given != bytes) status = other_length(s, given, bytes);
  return status ? status : copy(s, word(s), to, bytes);
}

static int block(const source *blocks, size_t from, size_t packed, unsigned char *to, size_t bytes)
{
  uLongf got = bytes;
  if (packed > blocks->left) return ends_early(blocks);
  unsigned char *buffer = SPH_NEW(unsigned char, packed, "a compressed block", blocks->error);
  if (!buffer) return SPH_ERR_MEMORY;
  int status = copy(blocks, from, buffer, packed);
  if (!status && (uncompress(to, &got, buffer, packed) != Z_OK || got != bytes))
    status = sph_error_set(blocks->error, SPH_ERR_FILE, "a block that zlib cannot unpack");
  sph_memory_free(buffer);
  return status;
}

static int compressed(const source *s, unsigned char *to, size_t bytes)
{
  uint64_t head[3] = {0}, packed = 0; /* blocks, length of a block, of the last (0: whole) */
  int status = SPH_OK;
  size_t done = 0, from = 0;
  for (size_t k = 0; k < 3 && !status && (k == 0 || head[0]); k++) status = length(s, k, &head[k]);
  if (!status && head[0] > s->left) status = ends_early(s);
  if (status) return status;
  source blocks = *s; /* encoded apart from the lengths */
  const size_t lengths = (3 + (size_t)head[0]) * word(s);
  const size_t there = s->base64 ? (lengths + 2) / 3 * 4 : lengths;
  if (head[0] && there > s->left) return ends_early(s);
  if (head[0]) blocks.at += there, blocks.left -= there;
  for (uint64_t k = 0; k < head[0] && !status; k++) {
    const uint64_t more = k + 1 == head[0] && head[2] ? head[2] : head[1];
    if (more > bytes - done) return other_length(s, done + more, bytes);
    status = length(s, 3 + (size_t)k, &packed);
    if (!status) status = block(&blocks, from, (size_t)packed, to + done, (size_t)more);
    from += (size_t)packed;
    done += (size_t)more;
  }
  if (!status && done != bytes) status = other_length(s, done, bytes);
  return status;
}

#define AS(T)                           \
  do {                                  \
    T value;                            \
    memcpy(&value, byte, sizeof value); \
    return (double)value;               \
  } while (0)

static double number(int type, const unsigned char *byte)
{
  switch (type) {
  case INT8: AS(int8_t);
  case UINT8: AS(uint8_t);
  case INT16: AS(int16_t);
  case UINT16: AS(uint16_t);
  case INT32: AS(int32_t);
  case UINT32: AS(uint32_t);
  case INT64: AS(int64_t);
  case UINT64: AS(uint64_t);
  case FLOAT32: AS(float);
  default: AS(double);
  }
}

static int binary(source *s, int type, double *to, size_t n)
{
  const size_t size = types[type].size;
  unsigned char *bytes = sph_memory_new(n, size, "an array of a VTU", s->error);
  if (!bytes) return SPH_ERR_MEMORY;
  while (s->base64 && s->left && isspace((unsigned char)*s->at)) s->at++, s->left--;
  int status = s->head->zlib ? compressed(s, bytes, n * size) : plain(s, bytes, n * size);
  for (size_t k = 0; k < n && !status; k++) {
    if (s->head->swap) swap(bytes + k * size, size);
    to[k] = number(type, bytes + k * size);
  }
  sph_memory_free(bytes);
  return status;
}

static int ascii(const source *s, double *to, size_t n)
{
  const char *at = s->at, *const end = s->at + s->left;
  for (size_t k = 0; k < n; k++) {
    char *behind;
    to[k] = strtod(at, &behind);
    if (behind == at || behind > end)
      return sph_error_set(s->error, SPH_ERR_FILE, "number %zu of %zu is missing or no number", k,
                           n);
    at = behind;
  }
  while (at < end && isspace((unsigned char)*at)) at++;
  if (at == end) return SPH_OK;
  return sph_error_set(s->error, SPH_ERR_FILE, "more behind its %zu numbers", n);
}

int sph_vtu_array_read(const sph_vtu_head *head, int coding, int type, const char *data,
                       size_t size, double *to, size_t n, sph_error *error)
{
  source s = {head, data, size, coding == SPH_VTU_BASE64, error};
  return coding == SPH_VTU_ASCII ? ascii(&s, to, n) : binary(&s, type, to, n);
}
#else
typedef int sph_vtu_array_unbuilt; /* a file of C declares something */
#endif
