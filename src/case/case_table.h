/* case_table.h -- a number over time, from a table. */
#ifndef SPH_CASE_TABLE_H
#define SPH_CASE_TABLE_H
#include "si_unit.h"
#include "sphode/base.h"

typedef struct sph_case_table sph_case_table;
struct sph_case;

/* The tables of a case, behind its parameters among the names that formulas of time may use
 * (c->timed); a status, the reason in c->error. */
int sph_case_table_read_all(struct sph_case *c);
/* The table at time t [s], in SI units: between its rows by a spline, before and behind them as it
 * says.  Allocates nothing. */
double sph_case_table_at(const sph_case_table *table, double t);
sph_case_table *sph_case_table_copy(const sph_case_table *table);
void sph_case_table_free(sph_case_table *table);

#endif
