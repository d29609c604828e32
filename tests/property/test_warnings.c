/* Warnings of an evaluated simulation: each is provoked, and says what was found and what is right;
 * what it calls right has none.  The cases that come along have none but those named here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <sphode.h>

static const double g = 10, H = 1;

typedef struct tank {
  const char *kernel;
  double dx, h_over_dx, c0;
  double layers;  /* of its walls [dx]; 0: as thick as the support */
  double spread;  /* the water's particles stand that much farther apart; 0: 1 */
  double width;   /* of the water [m]; 0: H */
  double moving;  /* of the water [m/s] */
  double driven;  /* of the tank [m/s] */
  double gravity; /* [m/s^2] */
  int rotated;    /* gravity along x, which is periodic */
  int hydrostatic;
} tank;

static double speed;

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)acceleration, (void)displacement;
  velocity[0] = speed * (t > 0);
}

static void add_tank(sph_sim *sim, const tank *k)
{
  const double thick = k->layers * k->dx, corner[2] = {0}, far[2] = {2, 2};
  if (k->layers == 0) {
    sph_group *wall = sph_group_walls(sim, "tank", corner, far, 1000);
    sph_boundary boundary = sph_boundary_adami();
    speed = k->driven;
    if (k->driven > 0) boundary.motion = slide;
    sph_group_set_boundary(wall, boundary);
    return;
  }
  sph_group *wall = sph_group_create(sim, "tank", "wall");
  sph_group_add_box(wall, (double[]){-thick, -thick}, (double[]){2 + thick, 0}, 1000);
  sph_group_add_box(wall, (double[]){-thick, 0}, (double[]){0, 2}, 1000);
  sph_group_add_box(wall, (double[]){2, 0}, (double[]){2 + thick, 2}, 1000);
  sph_group_set_boundary(wall, sph_boundary_adami());
}

static sph_sim *make(const tank *k)
{
  const double corner[2] = {0};
  sph_sim_def def = {.dim = 2, .dx = k->dx, .kernel = k->kernel, .h_over_dx = k->h_over_dx};
  if (k->rotated) def.periodic[0] = 1, def.length[0] = H;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *water =
      sph_group_box(sim, "water", corner, (double[]){k->width > 0 ? k->width : H, H}, 1000);
  if (!k->rotated) add_tank(sim, k);
  sph_group_set_eos(water, sph_eos_tait(1000, k->c0, 7));
  if (k->hydrostatic) sph_group_set_hydrostatic(water, 1, H, k->gravity);
  for (int d = 0; d < 2 && k->spread > 0; d++) {
    double *x = sph_group_write(water, "position", d);
    for (long i = 0; i < sph_group_count(water); i++) x[i] *= k->spread;
  }
  double *v = sph_group_write(water, "velocity", 1);
  for (long i = 0; v && i < sph_group_count(water); i++) v[i] = k->moving;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[3]){k->rotated ? k->gravity : 0,
                                                     k->rotated ? 0 : -k->gravity}));
  return sim;
}

/* Exactly these, each with the given beginnings of its parts. */
static void warned(const tank *k, int n, const char *const (*parts)[4])
{
  sph_sim *sim = make(k);
  char text[300] = "";
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  for (int w = 0; w < n; w++) {
    assert_int_equal(sph_sim_warning(sim, w, text, sizeof text), 1);
    for (int p = 0; p < 4 && parts[w][p]; p++)
      if (!strstr(text, parts[w][p])) fail_msg("\"%s\" lacks \"%s\"", text, parts[w][p]);
  }
  if (sph_sim_warning(sim, n, text, sizeof text)) fail_msg("also: \"%s\"", text);
  sph_sim_free(sim);
}

static tank sound(void)
{
  return (tank){.dx = 0.05, .c0 = 10 * sqrt(2 * g * H), .gravity = g, .hydrostatic = 1};
}

static void none(void **state)
{
  (void)state;
  tank k = sound();
  warned(&k, 0, NULL);
  k.layers = 3;
  warned(&k, 0, NULL);
  k.h_over_dx = 1.3;
  warned(&k, 0, NULL);
  k = sound(), k.rotated = 1, k.hydrostatic = 0, k.c0 = 1; /* nothing falls onto anything */
  warned(&k, 0, NULL);
}

static void range(void **state)
{
  (void)state;
  tank k = sound();
  k.h_over_dx = 1.2;
  warned(&k, 1,
         (const char *const[][4]){{"h = 1.2 dx", "wendland-c2 in 2D right is 1.3 to 2",
                                   "--spacing 0.05 --dim 2", "too few"}});
  k.kernel = "cubic-spline", k.h_over_dx = 2;
  warned(&k, 1,
         (const char *const[][4]){{"h = 2 dx", "cubic-spline in 2D right is 1.1 to 1.3", "pair"}});
}

static void mach(void **state)
{
  (void)state;
  tank k = sound();
  k.c0 = 40;
  warned(&k, 1,
         (const char *const[][4]){{"water can fall to sqrt(2 g H) = 4.47 m/s, 0.11", "40 m/s",
                                   "at most 0.1", "of 44.7 m/s or more"}});
  k = sound(), k.moving = 9;
  warned(&k, 1,
         (const char *const[][4]){
             {"water moves at 9 m/s, 0.2", "44.7 m/s", "at most 0.1", "of 90 m/s or more"}});
  k = sound(), k.driven = 6;
  warned(&k, 1,
         (const char *const[][4]){
             {"wall tank moves at 6 m/s, 0.13", "44.7 m/s", "at most 0.1", "of 60 m/s or more"}});
}

static void pressure(void **state)
{
  (void)state;
  tank k = sound();
  k.c0 = 20, k.hydrostatic = 0;
  const char *const fall[4] = {"can fall", "44.7"};
  warned(&k, 2,
         (const char *const[][4]){{fall[0], fall[1]},
                                  {"its own weight compresses it by g H/c0^2 = 2.5 %",
                                   "at most 1 %", "of 31.6 m/s or more", "not 20 m/s"}});
  k.c0 = 15, k.hydrostatic = 1;
  warned(&k, 3,
         (const char *const[][4]){{fall[0], fall[1]},
                                  {"g H/c0^2 = 4.4 %"},
                                  {"density starts ", "% off", "at most 3 %"}});
}

static void neighbors(void **state)
{
  (void)state;
  tank k = sound();
  k.spread = 1.9, k.hydrostatic = 0;
  k.c0 = 100;
  warned(&k, 2,
         (const char *const[][4]){
             {"neighbours on average", "right are 24", "a smaller spacing, or a larger h/dx"},
             {"water and tank: there is a gap between them, their particles are 1.45 dx apart"}});
}

static void thin_body(void **state)
{
  (void)state;
  tank k = sound();
  k.width = 0.1; /* the support: 0.15 m */
  warned(&k, 1,
         (const char *const[][4]){{"water: the support, 0.15 m to each side", "along x, 0.1 m",
                                   "a spacing of 0.0083 m or less", "not 0.05 m"}});
  k.width = 0.15;
  warned(&k, 0, NULL);
}

static void thin_walls(void **state)
{
  (void)state;
  tank k = sound();
  for (k.layers = 1; k.layers <= 2; k.layers++)
    warned(&k, 1,
           (const char *const[][4]){{"walls end within the support, 0.15 m, of ",
                                     "% of the fluid particles beside them",
                                     "right are 3 layers"}});
  k.h_over_dx = 2, k.layers = 3;
  warned(&k, 1, (const char *const[][4]){{"right are 4 layers"}});
  k.layers = 4;
  warned(&k, 0, NULL);
}

/* A front that has come further, points that are wet and dry already: told, with what is there;
 * what is still to come is not, nor what both directions wait for. */
static void events(void **state)
{
  const sph_event to_come[] = {
      {.name = "a", .type = "front", .threshold = 1.5},
      {.name = "b", .type = "front", .threshold = 0.5, .direction = "falling"},
      {.name = "c", .type = "front", .threshold = 0.5, .direction = "both"},
      {.name = "d", .type = "wet", .x = {1.5, 0.5}},
      {.name = "e", .type = "dry", .x = {0.5, 0.5}},
      {.name = "f", .type = "energy", .threshold = -1e9, .quantity = "total"},
      {.name = "g", .type = "steady", .threshold = 1},
      {.name = "h", .type = "time", .threshold = 1}};
  const sph_event passed[] = {{.name = "k", .type = "front", .threshold = 0.5},
                              {.name = "l", .type = "wet", .x = {0.5, 0.5}},
                              {.name = "m", .type = "dry", .x = {1.5, 0.5}},
                              {.name = "n",
                               .type = "energy",
                               .threshold = -1e9,
                               .quantity = "total",
                               .direction = "rising"}};
  static const char *const says[][2] = {{"event k: its front is 1 m", "above 0.5 m already"},
                                        {"event l: its point is wet when the run begins", ""},
                                        {"event m: its point is dry when the run begins", ""},
                                        {"event n: its energy is", "above -1e+09 J already"}};
  const tank k = sound();
  char text[300] = "";
  (void)state;
  sph_sim *sim = make(&k);
  for (size_t n = 0; n < sizeof to_come / sizeof *to_come; n++) sph_sim_add_event(sim, &to_come[n]);
  for (size_t n = 0; n < sizeof passed / sizeof *passed; n++) sph_sim_add_event(sim, &passed[n]);
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  for (int n = 0; n < 4; n++) {
    assert_int_equal(sph_sim_warning(sim, n, text, sizeof text), 1);
    if (!strstr(text, says[n][0]) || !strstr(text, says[n][1])) fail_msg("\"%s\"", text);
  }
  if (sph_sim_warning(sim, 4, text, sizeof text)) fail_msg("also: \"%s\"", text);
  sph_sim_free(sim);
}

/* ---- bodies in each other */

/* Particles dx = 0.05 m apart; oil lies on water, y = 0.5 m, but for (right, down) spacings. */
static sph_sim *layers(double right, double down, int periodic)
{
  const double dx = 0.05, move[2] = {right * dx, -down * dx};
  sph_sim_def def = {.dim = 2, .dx = dx};
  if (periodic) def.periodic[1] = 1, def.length[1] = 1;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  sph_group *oil = sph_group_box(sim, "oil", (double[]){0, 0.5}, (double[]){1, 1}, 800);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group_set_eos(oil, sph_eos_tait(800, 10, 7));
  for (int d = 0; d < 2; d++) {
    double *x = sph_group_write(oil, "position", d);
    for (long i = 0; i < sph_group_count(oil); i++) x[i] += move[d];
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  return sim;
}

/* The only warning has these parts; part[0] == NULL: there is none. */
static void says(sph_sim *sim, const char *const part[4])
{
  char text[400] = "";
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  assert_int_equal(sph_sim_warning(sim, 0, text, sizeof text), part[0] != NULL);
  for (int p = 0; p < 4 && part[p]; p++)
    if (!strstr(text, part[p])) fail_msg("\"%s\" lacks \"%s\"", text, part[p]);
  if (sph_sim_warning(sim, 1, text, sizeof text)) fail_msg("also: \"%s\"", text);
  sph_sim_free(sim);
}

/* Faces that touch, also askew, and bodies that are far apart have no warning. */
static void overlap(void **state)
{
  static const char *const none[4] = {NULL};
  static const char *const over[4] = {"water and oil: 20 particles of water",
                                      "nearer than 0.7 dx = 0.035 m",
                                      "the first at (0.025 0.475) m", "difference"};
  static const char *const gap[4] = {"water and oil: there is a gap", " 1.5 dx apart", "(0.",
                                     "1 is right"};
  (void)state;
  says(layers(0, 0, 0), none);
  says(layers(0.5, 0, 0), none);
  says(layers(0, 0.29, 0), none);
  says(layers(0, 0.31, 0), over);
  says(layers(0, 3.51, 0), (const char *const[4]){"water and oil: 80 particles of water"});
  says(layers(0, -0.24, 0), none);
  says(layers(0.5, -0.14, 0), none);
  says(layers(0, -0.5, 0), gap);
  says(layers(0, -0.91, 0), none);
  says(layers(0, -0.4, 1), /* oil's upper side meets the water's lower one */
       (const char *const[4]){"water and oil: 20 particles of water", "first at (0.025 0.025) m"});
}

/* A piston of 6 times 3 particles, in the floor of a tank or cut out of it. */
static void overlap_of_walls(void **state)
{
  (void)state;
  for (int cut = 0; cut < 2; cut++) {
    sph_sim *sim = layers(0, 0, 0);
    const double split[3] = {0.5, 0.8, 1.15};
    sph_group *floor = sph_group_create(sim, "tank", "wall");
    sph_group_add_box(floor, (double[]){-0.15, -0.15}, (double[]){split[0], 0}, 1000);
    if (!cut) sph_group_add_box(floor, (double[]){split[0], -0.15}, (double[]){split[1], 0}, 1000);
    sph_group_add_box(floor, (double[]){split[1], -0.15}, (double[]){split[2], 0}, 1000);
    sph_group *piston = sph_group_create(sim, "piston", "wall");
    sph_group_add_box(piston, (double[]){split[0], -0.15}, (double[]){split[1], 0}, 1000);
    sph_group_set_boundary(floor, sph_boundary_adami());
    sph_group_set_boundary(piston, sph_boundary_adami());
    says(sim, cut ? (const char *const[4]){NULL}
                  : (const char *const[4]){"tank and piston: 18 particles of tank",
                                           "the first at (0.525 -0.", "cut out of each other"});
  }
}

/* Liquids at 0.7 dx exactly are too near, and so are two shapes of one group; those that touch, or
 * were moved off their lattices, are not. */
static void overlap_within(void **state)
{
  const double dx = 0.05;
  (void)state;
  says(layers(0, 0.3, 0), (const char *const[4]){"water and oil: 20 particles of water"});
  for (int k = 0; k < 4; k++) {
    sph_sim *sim = layers(0, 0, 0);
    sph_group *wall = sph_group_create(sim, "tank", "wall");
    const double more = k == 1 ? 0.5 * dx : 0;
    sph_group_add_box(wall, (double[]){-3 * dx, -3 * dx}, (double[]){0.5, 0}, 1000);
    sph_group_add_box(wall, (double[]){0.5 - more, -3 * dx}, (double[]){1 + 3 * dx, 0}, 1000);
    if (k == 2) sph_group_jitter(wall, 0.3, 1);
    if (k == 3)
      sph_group_add_points(wall, 1, (const double *const[]){(double[]){0.53}, (double[]){-0.05}},
                           1000);
    sph_group_set_boundary(wall, sph_boundary_adami());
    says(sim, k == 1 ? (const char *const[4]){"tank: 6 of its particles are nearer than 0.7 dx = "
                                              "0.035 m to another",
                                              "the first at (0.475 -0.1", "union"}
                     : (const char *const[4]){NULL});
  }
}

/* ---- bodies beside each other */

/* A column of water, 1 m wide and high, of which the walls of a tank 2 m wide end `gap` spacings
 * away, or which stands elsewhere. */
static sph_sim *column(double gap, const double at[2], double gravity, double v_x, const char *open)
{
  const double dx = 0.05, low[2] = {at[0], at[1]}, high[2] = {at[0] + 1, at[1] + 1};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", low, high, 1000);
  sph_group *wall = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(wall, (double[]){-gap * dx, 0}, (double[]){2 - gap * dx, 2}, open, 1000);
  sph_group_set_boundary(wall, sph_boundary_adami());
  sph_group_set_eos(water, sph_eos_tait(1000, 100, 7));
  double *v = sph_group_write(water, "velocity", 0);
  for (long i = 0; v && i < sph_group_count(water); i++) v[i] = v_x;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -gravity}));
  return sim;
}

/* Less than the support, but more than particles that touch: a gap.  Air under a lid is none. */
static void gaps(void **state)
{
  static const char *const none[4] = {NULL};
  static const double origin[2] = {0, 0}, high[2] = {0, 0.1}, up[2] = {0, 0.95};
  (void)state;
  says(column(0, origin, g, 0, "y+"), none);
  says(column(0.2, origin, g, 0, "y+"), none);
  says(column(0.5, origin, g, 0, "y+"),
       (const char *const[4]){"water and tank: there is a gap between them, their particles are "
                              "1.5 dx apart along x",
                              "at (0.025 0.025) m", "1 is right"});
  says(column(1.5, origin, g, 0, "y+"), (const char *const[4]){"2.5 dx apart along x"});
  says(column(3, origin, g, 0, "y+"), none);
  says(column(0, (double[2]){0, 0.05}, g, 0, "y+"),
       (const char *const[4]){"2 dx apart along y, at (0.025 0.075) m"});
  says(column(0, high, g, 0, "y+"), none);
  says(column(0, up, g, 0, ""), none);
  says(column(0, up, 0, 0, ""), (const char *const[4]){"2 dx apart along y, at (0.025 1.925) m"});
}

static void far_away(void **state)
{
  static const char *const none[4] = {NULL};
  static const char *const away[4] = {"water lies from x = 3.02", "all walls from -0.1",
                                      "they will not hold it", "a wrong unit, or a sign?"};
  static const double beside[2] = {3, 0}, above[2] = {0, 3.5}, high[2] = {0, 30};
  (void)state;
  says(column(0, beside, g, 0, "y+"), away);
  says(column(0, beside, g, -1, "y+"), none); /* a jet */
  says(column(0, beside, 0, 0, "y+"), none);
  says(column(0, above, g, 0, "y+"), none); /* it falls into the tank */
  says(column(0, high, g / 10, 0, "y+"), (const char *const[4]){"water lies from y = 30.0"});
}

/* ---- steps */

static sph_sim *stepped(sph_term term, const sph_integrator_def *def)
{
  sph_sim *sim = layers(0, 0, 0);
  if (term.name) sph_sim_add_term(sim, term);
  sph_sim_set_integrator(sim, def);
  return sim;
}

/* Against the stability limits of the table, which bench/bench_stability.c measures. */
static void steps(void **state)
{
  static const char *const none[4] = {NULL};
  const sph_integrator_def usual = {.method = NULL}, leap = {.method = "leapfrog"};
  const double h = 0.075, c = 10;
  sph_integrator_info info = {.name = NULL};
  (void)state;
  for (int k = 0; sph_integrator_info_get(k, &info) && strcmp(info.name, "leapfrog"); k++) continue;
  says(stepped(sph_term_viscosity_artificial(2, 0), &usual), none);
  says(stepped(sph_term_viscosity_artificial(50, 0), &usual),
       (const char *const[4]){"alpha = 50 bounds steps to 1/31 of", "usual are 0.01 to 2",
                              "viscosity-laminar", "imex:"});
  says(stepped(sph_term_viscosity_signal(20, 0), &usual),
       (const char *const[4]){"alpha = 20 bounds steps to 1/13 of"});
  says(stepped(sph_term_delta("molteni", 0.5), &usual), none);
  says(stepped(sph_term_delta("molteni", 5), &usual),
       (const char *const[4]){"delta = 5 bounds steps to 1/27.5 of", "usual is 0.1",
                              "part: implicit"});
  sph_integrator_def def = leap;
  def.cfl = 1;
  says(stepped((sph_term){0}, &def), none);
  def.cfl = 8;
  says(stepped((sph_term){0}, &def),
       (const char *const[4]){"cfl = 8: steps of 8 times the longest that leapfrog is stable with",
                              "at most 1, by default 0.35"});
  def.cfl = 0, def.dt_fixed = info.stability * h / c;
  says(stepped((sph_term){0}, &def), none);
  def.dt_fixed *= 2;
  says(stepped((sph_term){0}, &def),
       (const char *const[4]){"is 2 times the longest step that leapfrog is stable with"});
  def = usual;
  def.cfl = 8; /* error control shortens them */
  says(stepped((sph_term){0}, &def), none);
  def.dt_fixed = 1;
  says(stepped((sph_term){0}, &def),
       (const char *const[4]){"dt_fixed = 1 s is ", "erk:bogacki-shampine-4-2-3 is stable with"});
}

/* A sharp corner, which no packing makes even; a disc becomes it; moves too few. */
static void uneven(void **state)
{
  static const double corner[3][2] = {{0, 0}, {1, 0}, {1.03, 0.5}}, centre[2] = {0, 0};
  (void)state;
  for (int k = 0; k < 3; k++) {
    sph_error error = {0};
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.05});
    sph_group *water = sph_group_create(sim, "water", "fluid");
    sph_shape *shape =
        k == 1 ? sph_shape_ball(2, centre, 0.5, &error) : sph_shape_polygon(3, corner, &error);
    sph_group_add_shape(water, shape,
                        &(sph_fill){.rho0 = 1000,
                                    .pack = &(sph_pack){.iterations = k == 2 ? 5 : 0}});
    sph_shape_free(shape);
    sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    says(sim,
         k == 1 ? (const char *const[4]){NULL}
                : (const char *const[4]){"water: packed in ", "not to 0.005 as wanted",
                                         k == 2 ? "no more were allowed; right are more iterations"
                                                : "more moves did not help"});
  }
}

/* So near that steps would be hopeless: an error, which says who and where. */
static void refused(void **state)
{
  (void)state;
  sph_sim *sim = layers(0, 0.95, 0);
  assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT);
  if (!strstr(sph_sim_error(sim), "40 particles start nearer than 0.1 dx = 0.005 m to another, the "
                                  "first of water at (0.025 0.475) m to one of oil"))
    fail_msg("\"%s\"", sph_sim_error(sim));
  sph_sim_free(sim);
}

/* ---- the cases that come along */

/* Those that have a warning, meant so: the patch is drawn out to almost twice dx; the standing wave
 * fills its tank, and nothing falls. */
static const struct {
  const char *file, *warning;
} meant[] = {{"elliptical-patch-2d.yml", "h = 2.5 dx"},
             {"standing-wave-2d.yml", "water can fall to"}};

static void check_case(const char *directory, const char *file)
{
  char path[800], text[300];
  const char *expected = NULL;
  sph_error error = {0};
  int n = 0;
  for (size_t k = 0; k < sizeof meant / sizeof *meant; k++)
    if (!strcmp(meant[k].file, file)) expected = meant[k].warning;
  snprintf(path, sizeof path, "%s/%s", directory, file);
  sph_case *c = sph_case_read(path, 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  if (!sim || sph_sim_evaluate(sim))
    fail_msg("%s: %s", file, sim ? sph_sim_error(sim) : error.text);
  for (; sph_sim_warning(sim, n, text, sizeof text); n++)
    if (!expected || !strstr(text, expected)) fail_msg("%s: %s", file, text);
  assert_int_equal(n, expected != NULL);
  if (sph_case_warning(c, 0, text, sizeof text) ||
      sph_case_warning_places(c, sim, 0, text, sizeof text))
    fail_msg("%s: %s", file, text);
  sph_sim_free(sim);
  sph_case_free(c);
}

static void shipped(void **state)
{
  (void)state;
  char path[400];
  const char *source = getenv("SRCDIR");
  const struct dirent *entry;
  int n = 0;
  snprintf(path, sizeof path, "%s/cases", source ? source : ".");
  DIR *cases = opendir(path);
  assert_non_null(cases);
  while ((entry = readdir(cases))) {
    const char *end = strrchr(entry->d_name, '.');
    if (!end || strcmp(end, ".yml")) continue;
    check_case(path, entry->d_name);
    n++;
  }
  closedir(cases);
  print_message("# %d cases\n", n);
  assert_true(n >= 18);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(none),
      cmocka_unit_test(range),
      cmocka_unit_test(mach),
      cmocka_unit_test(pressure),
      cmocka_unit_test(neighbors),
      cmocka_unit_test(thin_body),
      cmocka_unit_test(thin_walls),
      cmocka_unit_test(events),
      cmocka_unit_test(shipped),
      cmocka_unit_test(overlap),
      cmocka_unit_test(overlap_of_walls),
      cmocka_unit_test(overlap_within),
      cmocka_unit_test(gaps),
      cmocka_unit_test(far_away),
      cmocka_unit_test(steps),
      cmocka_unit_test(uneven),
      cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
