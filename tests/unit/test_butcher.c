/* Butcher tables of the Runge-Kutta integrators: all order conditions of the method and of its
 * embedding, one for each rooted tree (Butcher 1963; Hairer, Norsett & Wanner 1993, section II.2),
 * for pairs of tables one for each way to give its edges to them (Araujo, Murua & Sanz-Serna 1997);
 * those of Ranocha et al. (2022) against the b and c printed there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "integrator_table.h"

enum { STAGES = 20, TREES = 800, MOST = 10 }; /* trees of 1 to 9 vertices: 486; 10: 719 more */

typedef struct tree {
  int order;
  double density, weight[STAGES]; /* gamma(t); Phi_i(t) without the b_i */
} tree;

typedef struct forest {
  ARKodeButcherTable table[2]; /* NULL: not a pair */
  tree tree[TREES];
  int trees;
} forest;

/* t with one more branch: Phi_i *= sum_j a_ij Phi_j(branch). */
static tree grow(ARKodeButcherTable table, tree t, const tree *branch)
{
  for (int i = 0; i < table->stages; i++) {
    double sum = 0;
    for (int j = 0; j < table->stages; j++) sum += table->A[i][j] * branch->weight[j];
    t.weight[i] *= sum;
  }
  t.density *= branch->density;
  return t;
}

/* All trees whose branches are those of t and more of the trees up to number last/tables, by the
 * edge to one of the tables, with `left` vertices in all. */
static void branch(forest *f, tree t, int last, int left)
{
  if (left == 0) {
    t.density *= t.order;
    assert_true(f->trees < TREES);
    f->tree[f->trees++] = t;
    return;
  }
  for (int k = last, tables = 1 + !!f->table[1]; k >= 0; k--) {
    const tree *next = &f->tree[k / tables];
    if (next->order <= left) branch(f, grow(f->table[k % tables], t, next), k, left - next->order);
  }
}

/* table2: NULL or the other one of a pair. */
static void plant(forest *f, ARKodeButcherTable table, ARKodeButcherTable table2, int order)
{
  static const int count[2][MOST] = {{0, 1, 1, 2, 4, 9, 20, 48, 115, 286},
                                     {0, 1, 2, 7, 26, 107, 458}};
  f->table[0] = table;
  f->table[1] = table2;
  f->trees = 0;
  assert_in_range(table->stages, 1, STAGES);
  for (int n = 1; n <= order; n++) {
    tree t = {.order = n, .density = 1};
    for (int i = 0; i < table->stages; i++) t.weight[i] = 1;
    int before = f->trees;
    branch(f, t, table2 ? 2 * before - 1 : before - 1, n - 1);
    assert_int_equal(f->trees - before, count[table2 != NULL][n]);
  }
}

/* Largest |sum b_i Phi_i - 1/gamma| over trees of `from` to `to` vertices. */
static double defect(const forest *f, const double *b, int from, int to)
{
  double most = 0;
  for (int k = 0; k < f->trees; k++) {
    const tree *t = &f->tree[k];
    double sum = -1 / t->density;
    if (t->order < from || t->order > to) continue;
    for (int i = 0; i < f->table[0]->stages; i++) sum += b[i] * t->weight[i];
    most = fmax(most, fabs(sum));
  }
  return most;
}

static void check_rows(const char *name, ARKodeButcherTable t, double near)
{
  for (int i = 0; i < t->stages; i++) {
    double sum = -t->c[i];
    for (int j = 0; j < t->stages; j++) {
      sum += t->A[i][j];
      if (j >= i) assert_true(t->A[i][j] == 0); /* explicit */
    }
    if (!(fabs(sum) < near)) fail_msg("%s: sum of row %d is off by %.1e", name, i, sum);
  }
}

static void order_conditions_hold(void **state)
{
  static forest f;
  const char *name;
  int seen = 0;
  (void)state;
  for (int k = 0; (name = sph_integrator_table_name(k)); k++) {
    ARKodeButcherTable t = sph_integrator_table_butcher(k);
    if (!t) continue;
    /* ARKODE's are as exact as printed: one of Verner's to eleven digits */
    double near = sph_integrator_table_control(k) ? 1e-14 : 1e-10;
    int q = t->q < 9 ? t->q : 8;
    plant(&f, t, NULL, q + 1);
    double off = defect(&f, t->b, 1, q), next = defect(&f, t->b, q + 1, q + 1);
    if (!(off < near)) fail_msg("%s: order %d off by %.1e", name, t->q, off);
    if (t->q < 9 && !(next > 1e-8)) fail_msg("%s: also of order %d", name, t->q + 1);
    check_rows(name, t, near);
    if (t->d && t->p > 0) {
      off = defect(&f, t->d, 1, t->p);
      if (!(off < near)) fail_msg("%s: embedding of order %d off by %.1e", name, t->p, off);
      assert_true(defect(&f, t->d, t->p + 1, t->p + 1) > 1e-6);
    }
    ARKodeButcherTable_Free(t);
    seen++;
  }
  assert_true(seen >= 19);
}

/* Both tables have the same nodes and weights; the implicit one solves all stages but the first
 * with one gamma, and ends with its weights, so that it is L-stable. */
static void order_conditions_of_pairs_hold(void **state)
{
  static forest f;
  ARKodeButcherTable t[2];
  const char *name;
  int seen = 0;
  (void)state;
  for (int k = 0; (name = sph_integrator_table_name(k)); k++) {
    if (!sph_integrator_table_pair(k, t)) continue;
    int q = t[0]->q, p = t[0]->p, last = t[0]->stages - 1;
    plant(&f, t[0], t[1], q + 1);
    double off = defect(&f, t[0]->b, 1, q), off_embedded = defect(&f, t[0]->d, 1, p);
    if (!(off < 1e-10 && off_embedded < 1e-10))
      fail_msg("%s: order %d off by %.1e, %d by %.1e", name, q, off, p, off_embedded);
    assert_true(defect(&f, t[0]->b, q + 1, q + 1) > 1e-6);
    assert_true(defect(&f, t[0]->d, p + 1, p + 1) > 1e-6);
    check_rows(name, t[0], 1e-10);
    for (int i = 0; i <= last; i++) {
      double sum = -t[1]->c[i];
      for (int j = 0; j <= last; j++) sum += t[1]->A[i][j];
      assert_true(fabs(sum) < 1e-10 && fabs(t[0]->c[i] - t[1]->c[i]) < 1e-14);
      assert_true(t[0]->b[i] == t[1]->b[i] && t[0]->d[i] == t[1]->d[i]);
      assert_true(t[1]->A[i][i] == (i ? t[1]->A[1][1] : 0) && t[1]->A[last][i] == t[1]->b[i]);
    }
    for (int i = 0; i < 2; i++) ARKodeButcherTable_Free(t[i]);
    seen++;
  }
  assert_true(seen >= 5);
}

/* As printed, to 16 digits. */
static const struct {
  const char *name;
  int stages;
  double b[9], c[9];
} printed[] = {
    {"erk:rdpk3sp35-5-2-3",
     5,
     {1.147931563369900682e-01, 8.933559295232859014e-02, 4.355858717379231780e-01,
      2.473585295257286268e-01, 1.129268494470295369e-01},
     {0, 2.300285062878154352e-01, 4.050049049262914976e-01, 8.947823877926760225e-01,
      7.235108137218888081e-01}},
    {"erk:rdpk3sp49-9-3-4",
     9,
     {4.503731969165884304e-02, 1.859217322011968813e-01, 3.329727509207630932e-02,
      -4.784222621050198910e-03, 4.055848062637567926e-03, 4.185027999682794463e-01,
      -4.381894507474277848e-03, 2.712846097324442608e-02, 2.952226811394310028e-01},
     {0, 2.836343531977826023e-01, 5.484073767552486705e-01, 3.687229456675706937e-01,
      -6.806119916032093175e-01, 3.518526451892056369e-01, 1.665941920204672095e+00,
      9.715276989307335935e-01, 9.051569554420045340e-01}},
    {"erk:rdpk3spfsal35-6-2-3",
     5,
     {1.147935971023541172e-01, 8.933442853113315593e-02, 4.355871025008616992e-01,
      2.473576188201451147e-01, 1.129272530455059130e-01},
     {0, 2.300298624518076224e-01, 4.050046072094990912e-01, 8.947822893693433546e-01,
      7.235136928826589010e-01}},
    {"erk:rdpk3spfsal49-10-3-4",
     9,
     {4.503732627263753698e-02, 1.859217303699847950e-01, 3.329729672569717600e-02,
      -4.784204180958975587e-03, 4.055835961031310728e-03, 4.185027772596074198e-01,
      -4.381901968919326084e-03, 2.712843796446089829e-02, 2.952227015964591649e-01},
     {0, 2.836343005184365275e-01, 5.484076570002894365e-01, 3.687228761669438493e-01,
      -6.806126440140844191e-01, 3.518526124230705802e-01, 1.665941994879593315e+00,
      9.715279295934715835e-01, 9.051569840159589595e-01}},
};

static void low_storage_pairs_are_as_printed(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof printed / sizeof *printed; k++) {
    int row = sph_integrator_table_find(printed[k].name, NULL), n = printed[k].stages;
    ARKodeButcherTable t = sph_integrator_table_butcher(row);
    assert_non_null(t);
    assert_int_equal(t->stages, n + (strstr(printed[k].name, "fsal") != NULL));
    for (int i = 0; i < n; i++) {
      assert_float_equal(t->b[i], printed[k].b[i], 1e-15);
      assert_float_equal(t->c[i], printed[k].c[i], 4e-15);
    }
    assert_int_equal(sph_integrator_table_fsal(t), t->stages > n);
    ARKodeButcherTable_Free(t);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_conditions_hold),
      cmocka_unit_test(order_conditions_of_pairs_hold),
      cmocka_unit_test(low_storage_pairs_are_as_printed),
  };
  return cmocka_run_group_tests_name("butcher tables", tests, NULL, NULL);
}
