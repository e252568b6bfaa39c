/* Fields: samples, fields.h5 and fields.xdmf, and their readers. */
#include "drive.h"
#include "scenes.h"
#include "shell.h"

#include <math.h>
#include <signal.h>
#include <sys/stat.h>

static struct sample allocate_sample(size_t points)
{
  return (struct sample){.rho = calloc(points, sizeof(double)),
                         .velocity = calloc(3 * points, sizeof(double)),
                         .vorticity = calloc(points, sizeof(double)),
                         .pressure = calloc(points, sizeof(double)),
                         .occupation = calloc(points, sizeof(double))};
}

static struct sample take(struct simulation *simulation, const struct sample_grid *grid)
{
  struct status status;
  const struct sample sample = allocate_sample(sample_points(grid));
  cr_assert(simulation_sample(simulation, grid, &sample, &status), "%s", status.message);
  return sample;
}

Test(sample, has_the_values_of_the_cells_it_names)
{
  enum { NX = 70, NY = 60 };
  struct scene scene = scene_box(NX, NY, 0.05, SIDES_PERIODIC);
  scene.fluid.force[0] = 1e-5;
  scene_add_disc(&scene, 6.3, 1.5, 20, 30)->velocity[1] = 0.04;
  const struct sample_grid grid = {.first = {3, 5}, .count = {20, 18}, .stride = 3};
  struct simulation *simulation = start(&scene);
  static double rho[NX * NY], ux[NX * NY], uy[NX * NY];
  for (int odd = 0; odd < 2; odd++) {
    advance(simulation, 51);
    simulation_fields(simulation, rho, ux, uy);
    const struct sample sample = take(simulation, &grid);
    for (int j = 0; j < grid.count[1]; j++)
      for (int i = 0; i < grid.count[0]; i++) {
        const int x = grid.first[0] + 3 * i, y = grid.first[1] + 3 * j, cell = y * NX + x, at = j * grid.count[0] + i;
        cr_assert_eq(sample.rho[at], rho[cell]);
        cr_assert_eq(sample.pressure[at], (rho[cell] - 1) / 3);
        cr_assert_eq(sample.velocity[3 * at], ux[cell]);
        cr_assert_eq(sample.velocity[3 * at + 1], uy[cell]);
        cr_assert_eq(sample.velocity[3 * at + 2], 0);
        const double vorticity = (uy[cell + 1] - uy[cell - 1]) / 2 - (ux[cell + NX] - ux[cell - NX]) / 2;
        cr_assert_float_eq(sample.vorticity[at], vorticity, 1e-15);
      }
  }
}

Test(sample, counts_what_discs_cover_once)
{
  struct scene scene = scene_box(60, 50, 0.05, SIDES_PERIODIC);
  struct disc_spec *disc = scene_add_disc(&scene, 7, 1, 58.3, 24.6);
  disc->motion = DISC_FIXED;
  disc->spin = 0.02; /* its weights are less than 1 */
  const struct sample_grid grid = {.count = {60, 50}, .stride = 1};
  struct sample sample = take(start(&scene), &grid);
  double sum = 0, largest = 0;
  for (int k = 0; k < 3000; k++) sum += sample.occupation[k], largest = fmax(largest, sample.occupation[k]);
  cr_expect_float_eq(sum, M_PI * 49, 1e-9, "%.17g", sum);
  cr_expect_float_eq(largest, 1, 1e-15);
  /* a second disc over much of the first: no cell is counted twice */
  scene_add_disc(&scene, 7, 1, 56, 24.6)->motion = DISC_FIXED;
  sample = take(start(&scene), &grid);
  for (int k = 0; k < 3000; k++) cr_assert_leq(sample.occupation[k], 1);
}

/* The occupation of each cell, to be freed. */
static double *occupation_of(const struct scene *scene)
{
  const struct sample_grid grid = {.count = {scene->domain.size[0], scene->domain.size[1]}, .stride = 1};
  double *occupation = calloc(sample_points(&grid), sizeof *occupation);
  struct simulation *simulation = start(scene);
  struct status status;
  cr_assert(simulation_sample(simulation, &grid, &(struct sample){.occupation = occupation}, &status));
  simulation_destroy(simulation);
  return occupation;
}

/* One disc: its area (test_occupation). A pair: in each cell the sum of both areas. */
Test(sample, has_in_each_cell_of_a_pair_the_sum_of_both_fractions)
{
  for (int form = 0; form < FORM_COUNT; form++)
    for (int motion = DISC_FREE; motion <= DISC_DRIVEN; motion++) {
      struct scene both = scene_box(40, 30, 0.05, SIDES_CLOSED), alone[2];
      both.coupling.form = form;
      const struct disc_spec discs[2] = {
          {.radius = 5.3, .density = 2, .position = {14.2, 4.9}, .spin = 0.02, .motion = (enum disc_motion)motion},
          {.radius = 6.1, .density = 1, .position = {24.4, 8.7}, .motion = DISC_FIXED}};
      for (int i = 0; i < 2; i++) {
        const struct disc_spec *disc = &discs[i];
        alone[i] = both;
        alone[i].particles.discs = NULL, alone[i].particles.count = 0;
        *scene_add_disc(&alone[i], disc->radius, disc->density, 0, 0) = *disc;
      }
      for (int i = 0; i < 2; i++) *scene_add_disc(&both, 1, 1, 0, 0) = discs[i];
      double *of_both = occupation_of(&both), *of_one = occupation_of(&alone[0]), *of_other = occupation_of(&alone[1]);
      int shared = 0;
      for (int k = 0; k < 40 * 30; k++) {
        const double sum = of_one[k] + of_other[k];
        cr_assert_float_eq(of_both[k], fmin(1, sum), 1e-12, "form %d, motion %d, cell (%d, %d): %g, not %g", form,
                           motion, k % 40, k / 40, of_both[k], sum);
        shared += of_one[k] > 0 && of_other[k] > 0 && sum < 1;
      }
      cr_expect_gt(shared, 0, "the discs share cells that they do not fill");
      free(of_both), free(of_one), free(of_other);
      for (int i = 0; i < 2; i++) scene_clear(&alone[i]);
      scene_clear(&both);
    }
}

/* Half of body force and zero-flux force enters the velocity. */
Test(sample, fields_that_are_set_are_read_back_whatever_the_forces)
{
  enum { NX = 30, NY = 26, CELLS = NX * NY };
  static double density[CELLS], ux[CELLS], uy[CELLS], read[3][CELLS];
  for (int zero_flux = 0; zero_flux < 2; zero_flux++)
    for (int odd = 0; odd < 2; odd++) {
      struct scene scene = scene_box(NX, NY, 0.05, SIDES_CLOSED);
      scene.fluid.force[0] = 2e-4, scene.fluid.force[1] = -3e-4;
      scene.fluid.zero_flux = zero_flux;
      scene.domain.side[SIDE_TOP].velocity[0] = 0.05;
      scene.domain.side[SIDE_RIGHT].velocity[1] = 0.04;
      struct simulation *simulation = start(&scene);
      struct status status;
      advance(simulation, 10 + odd);
      for (int k = 0; k < CELLS; k++) {
        density[k] = 1 + 0.01 * sin(k);
        ux[k] = 0.03 * sin(0.1 * k);
        uy[k] = 0.02 * cos(0.07 * k);
      }
      simulation_set_fluid(simulation, density, ux, uy);
      cr_assert(simulation_changed(simulation, &status), "%s", status.message);
      simulation_fields(simulation, read[0], read[1], read[2]);
      for (int k = 0; k < CELLS; k++) {
        cr_assert_float_eq(read[0][k], density[k], 1e-14);
        cr_assert_float_eq(read[1][k], ux[k], 1e-14, "zero_flux %d, cell %d: %g, not %g", zero_flux, k, read[1][k],
                           ux[k]);
        cr_assert_float_eq(read[2][k], uy[k], 1e-14, "zero_flux %d, cell %d: %g, not %g", zero_flux, k, read[2][k],
                           uy[k]);
      }
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
}

Test(sample, wraps_vorticity_at_periodic_sides_alone)
{
  struct scene scene = scene_box(40, 30, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.1;
  const struct sample_grid grid = {.count = {40, 30}, .stride = 1};
  struct simulation *simulation = start(&scene);
  advance(simulation, 100);
  const struct sample sample = take(simulation, &grid);
  const double *u = sample.velocity;
  cr_expect_float_eq(sample.vorticity[29 * 40 + 20],
                     (u[3 * (29 * 40 + 21) + 1] - u[3 * (29 * 40 + 19) + 1]) / 2 -
                         (u[3 * (29 * 40 + 20)] - u[3 * (28 * 40 + 20)]),
                     1e-15);
}

#ifdef DELBM_HDF5

#include <hdf5.h>

static const char *const flow =
    "domain: {size: [120, 100], left: periodic, right: periodic}\n"
    "fluid: {viscosity: 0.05}\n"
    "particles:\n"
    "  density: 1.3\n"
    "  gravity: [0, -4e-4]\n"
    "  discs: [{radius: 9, position: [50, 70]}, {radius: 8, position: [115, 40], spin: 0.01}]\n"
    "run: {steps: 250}\n"
    "output: {every: 50, fields: {every: 100, region: [10, 5, 110, 96], stride: 3}}\n";

static void enter(void)
{
  shell_enter();
  shell_write("flow.yaml", flow);
}

TestSuite(fields, .init = enter, .fini = shell_leave, .timeout = 120 * SLOWNESS);

/* Debian's Python, which has h5py (python3-h5py), may not be the first on the path. */
static const char *python(void)
{
  static const char *const names[] = {"/usr/bin/python3", "python3"};
  for (int k = 0; k < 2; k++)
    if (shell("%s -c 'import h5py' 2>/dev/null", names[k]) == 0) return names[k];
  cr_skip_test("h5py is not installed");
}

Test(fields, are_the_same_bytes_from_the_same_run)
{
  cr_assert_eq(shell("OMP_NUM_THREADS=1 $DELBM run flow.yaml --quiet --out a >/dev/null && sleep 1.1 && "
                     "OMP_NUM_THREADS=2 $DELBM run flow.yaml --quiet --out b >/dev/null"),
               0);
  cr_expect_eq(shell("cmp a/fields.h5 b/fields.h5 && cmp a/fields.xdmf b/fields.xdmf && test -s a/fields.h5"), 0);
}

Test(fields, are_read_by_h5py)
{
  shell_write("read.py", "import h5py\n"
                         "f = h5py.File('a/fields.h5', 'r')\n"
                         "assert list(f) == ['00000000', '00000100', '00000200', '00000250'], list(f)\n"
                         "assert list(f.attrs['first_cell']) == [10, 5] and f.attrs['stride'] == 3\n"
                         "assert list(f.attrs['domain_size']) == [120, 100]\n"
                         "for step in f:\n"
                         "    g = f[step]\n"
                         "    assert g.attrs['step'] == int(step)\n"
                         "    for name in 'rho', 'vorticity', 'pressure', 'occupation':\n"
                         "        assert g[name].shape == (31, 34) and g[name].compression == 'gzip', name\n"
                         "        assert g[name].chunks == (31, 34) and g[name].dtype == 'f8'\n"
                         "    assert g['velocity'].shape == (31, 34, 3)\n"
                         "    assert abs(g['rho'][:].mean() - 1) < 1e-2\n"
                         "rows = [r.split(',') for r in open('a/particles.csv')][1:]\n"
                         "for r in rows:\n"
                         "    if '%08d' % int(r[0]) not in f: continue\n"
                         "    d, i = f['%08d/discs' % int(r[0])], int(r[1])\n"
                         "    assert list(d['id']) == [0, 1, 1] and list(d['radius']) == [9, 8, 8]\n"
                         "    assert list(d['position'][i]) == [float(r[2]), float(r[3]), 0]\n"
                         "    assert list(d['velocity'][i]) == [float(r[4]), float(r[5]), 0]\n"
                         "    assert d['spin'][i] == float(r[6]) and d['angle'][i] == float(r[7])\n"
                         "    image = list(d['position'][2])\n"
                         "    if i == 1: assert image == [float(r[2]) - 120, float(r[3]), 0]\n");
  const char *interpreter = python();
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a >/dev/null"), 0);
  cr_expect_eq(shell("%s read.py", interpreter), 0);
}

/* Origin and spacing refer to the samples' cell centres, z first. */
Test(fields, have_their_place_and_their_discs_in_the_xdmf_file)
{
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a --set run.steps=1 >/dev/null"), 0);
  cr_expect_eq(shell("grep -q '>0 5.5 10.5</DataItem>' a/fields.xdmf && grep -q '>1 3 3</DataItem>' a/fields.xdmf"), 0);
  cr_expect_eq(shell("test $(grep -c 'NumberOfElements=\"3\"' a/fields.xdmf) = 2"), 0, "two discs and an image");
  shell_write("one.yaml", "domain: {size: [40, 30]}\n"
                          "fluid: {viscosity: 0.1}\n"
                          "particles: {discs: [{radius: 4, position: [20, 15], fixed: true}]}\n"
                          "run: {steps: 0}\n"
                          "output: {fields: {every: 1}}\n");
  cr_assert_eq(shell("$DELBM run one.yaml --quiet --out b >/dev/null"), 0);
  cr_expect_eq(shell("test $(grep -c 'NumberOfElements=\"1\"' b/fields.xdmf) = 1"), 0, "one disc");
}

Test(fields, open_in_paraview)
{
  shell_write("view.py",
              "from paraview.simple import XDMFReader\n"
              "from paraview import servermanager\n"
              "reader = XDMFReader(FileNames=['a/fields.xdmf'])\n"
              "reader.UpdatePipelineInformation()\n"
              "assert list(reader.TimestepValues) == [0, 100, 200, 250]\n"
              "reader.UpdatePipeline(200)\n"
              "data = servermanager.Fetch(reader)\n"
              "flow, discs = data.GetBlock(0), data.GetBlock(1)\n"
              "assert flow.GetBounds() == (10.5, 109.5, 5.5, 95.5, 0, 0), flow.GetBounds()\n"
              "p = flow.GetPointData()\n"
              "for name, parts in ('rho', 1), ('velocity', 3), ('vorticity', 1), ('pressure', 1), ('occupation', 1):\n"
              "    a = p.GetArray(name)\n"
              "    assert a.GetNumberOfTuples() == 34 * 31 and a.GetNumberOfComponents() == parts, name\n"
              "assert p.GetArray('occupation').GetRange() == (0, 1)\n"
              "assert discs.GetNumberOfPoints() == 3 and discs.GetNumberOfCells() > 0\n"
              "d = discs.GetPointData()\n"
              "assert d.GetArray('radius').GetRange() == (8, 9) and d.GetArray('id').GetRange() == (0, 1)\n"
              "assert d.GetArray('velocity').GetRange(1)[0] < 0 and d.GetArray('angle').GetRange()[1] > 0.1\n"
              "assert abs(discs.GetPoint(1)[0] - discs.GetPoint(2)[0] - 120) < 1e-4\n");
  if (shell("command -v pvpython >/dev/null") != 0) cr_skip_test("ParaView is not installed");
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a >/dev/null"), 0);
  cr_expect_eq(
      shell("pvpython --force-offscreen-rendering view.py 2>err; c=$?; grep -iE 'error|ERR\\|' err && exit 9; exit $c"),
      0);
}

/* A whole dataset of a/fields.h5, to be freed. */
static double *read_set(const char *path)
{
  const hid_t file = H5Fopen("a/fields.h5", H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen2(file, path, H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  double *values = calloc((size_t)H5Sget_simple_extent_npoints(space), sizeof *values);
  cr_assert_geq(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0, "%s", path);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return values;
}

Test(fields, of_poiseuille_flow_are_the_parabola_and_its_slope)
{
  enum { NX = 8, NY = 13 };
  const double force = 1e-6, viscosity = 0.1;
  shell_write("channel.yaml", "domain: {size: [8, 13], left: periodic, right: periodic}\n"
                              "fluid: {viscosity: 0.1, force: [1e-6, 0], collision: trt}\n"
                              "run: {steps: 20000}\n"
                              "output: {every: 0, fields: {every: 20000}}\n");
  cr_assert_eq(shell("$DELBM run channel.yaml --quiet --out a >/dev/null"), 0);
  double *rho = read_set("00020000/rho"), *u = read_set("00020000/velocity"), *w = read_set("00020000/vorticity");
  const double largest = force / (2 * viscosity) * NY * NY / 4.0;
  for (int cell = 0; cell < NX * NY; cell++) {
    const int y = cell / NX;
    const double at = y + 0.5 - NY / 2.0;
    cr_expect_float_eq(u[3 * cell], force / (2 * viscosity) * (NY * NY / 4.0 - at * at), 1e-9 * largest);
    cr_expect_float_eq(u[3 * cell + 1], 0, 1e-9 * largest);
    cr_expect_float_eq(rho[cell], 1, 1e-12);
    if (y > 0 && y < NY - 1) cr_expect_float_eq(w[cell], force / viscosity * at, 1e-9 * largest);
  }
  free(rho), free(u), free(w);
}

Test(fields, of_fluid_at_rest_have_the_pressure_that_balances_its_weight)
{
  enum { NX = 6, NY = 30 };
  const double weight = 1e-5;
  shell_write("still.yaml", "domain: {size: [6, 30]}\n"
                            "fluid: {viscosity: 0.3, force: [0, -1e-5], collision: trt}\n"
                            "run: {steps: 20000}\n"
                            "output: {every: 0, fields: {every: 20000}}\n");
  cr_assert_eq(shell("$DELBM run still.yaml --quiet --out a >/dev/null"), 0);
  double *p = read_set("00020000/pressure"), *u = read_set("00020000/velocity");
  for (int cell = NX; cell < NX * NY; cell++) {
    const double rho = 1 + 3 * (p[cell] + p[cell - NX]) / 2;
    cr_expect_float_eq(p[cell - NX] - p[cell], rho * weight, 1e-8 * weight);
    cr_expect_float_eq(u[3 * cell + 1], 0, 1e-6 * weight);
  }
  free(p), free(u);
}

Test(fields, of_discs_cover_their_area)
{
  shell_write("still.yaml", "domain: {size: [60, 50], left: periodic, right: periodic}\n"
                            "fluid: {viscosity: 0.05}\n"
                            "particles: {discs: [{radius: 7, position: [58.3, 24.6], fixed: true}]}\n"
                            "run: {steps: 0}\n"
                            "output: {fields: {every: 1}}\n");
  cr_assert_eq(shell("$DELBM run still.yaml --quiet --out a >/dev/null"), 0);
  double *occupation = read_set("00000000/occupation"), sum = 0;
  for (int cell = 0; cell < 60 * 50; cell++) sum += occupation[cell];
  cr_expect_float_eq(sum, M_PI * 49, 1e-9, "%.17g", sum);
  free(occupation);
}

/* A run of flow.yaml in `cut` that is killed once there are more than so many snapshots, and checkpoints. */
static void cut_after(int snapshots)
{
  cr_assert_eq(
      shell("$DELBM run flow.yaml --quiet --out cut --set run.steps=100000000 --set output.fields.every=10 "
            "--set output.checkpoint.every=25 >/dev/null 2>&1 & p=$!; "
            "until test $(ls cut/fields 2>/dev/null | wc -l) -gt %d -a -e cut/checkpoint.1; do sleep 0.01; done; "
            "kill -KILL $p; wait $p; sed -i 's/steps: 100000000/steps: 3000/' cut/case.yaml",
            snapshots),
      0);
}

/* How the snapshots of a file lie in it: all by hard links, or all by external ones. */
static int count_links(const char *path, H5L_type_t type)
{
  int count = 0;
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  H5G_info_t group;
  cr_assert(file >= 0 && H5Gget_info(file, &group) >= 0, "%s", path);
  for (hsize_t k = 0; k < group.nlinks; k++) {
    H5L_info_t link;
    cr_assert(H5Lget_info_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, k, &link, H5P_DEFAULT) >= 0);
    count += link.type == type;
  }
  H5Fclose(file);
  return count;
}

Test(fields, of_a_run_that_ended_are_one_file_without_links_to_others)
{
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a >/dev/null; ls a/fields a/*.tmp 2>/dev/null"), 2);
  cr_expect_eq(count_links("a/fields.h5", H5L_TYPE_HARD), 4);
  cr_expect_eq(count_links("a/fields.h5", H5L_TYPE_EXTERNAL), 0);
}

Test(fields, of_a_killed_run_are_read_through_an_index_by_h5py)
{
  shell_write("read.py", "import h5py\n"
                         "f = h5py.File('cut/fields.h5', 'r')\n"
                         "assert len(f) > 11 and list(f)[:2] == ['00000000', '00000010'], list(f)\n"
                         "assert list(f.attrs['first_cell']) == [10, 5] and f.attrs['stride'] == 3\n"
                         "for step in f:\n"
                         "    g = f[step]\n"
                         "    assert g.attrs['step'] == int(step) and f[step + '/velocity'].shape == (31, 34, 3)\n"
                         "    assert isinstance(f.get(step, getlink=True), h5py.ExternalLink)\n"
                         "    assert abs(g['rho'][:].mean() - 1) < 1e-2 and list(g['discs/id']) == [0, 1, 1]\n");
  const char *interpreter = python();
  cut_after(12);
  cr_expect_eq(shell("%s read.py", interpreter), 0);
}

Test(fields, that_are_damaged_or_missing_are_named_on_resume_and_left_as_they_are)
{
  static const struct {
    const char *change, *said;
  } all[] = {
      {"rm cut/fields/00000040.h5", "cannot open cut/fields/00000040.h5: No such file or directory"},
      {"rm cut/fields/00000040.h5; mkfifo cut/fields/00000040.h5", "00000040.h5: it is not a plain file"},
      {"truncate -s 999 cut/fields/00000040.h5", "cut/fields/00000040.h5: .*step 40 is damaged or missing"},
      {"truncate -s 9 cut/fields.h5", "cannot read cut/fields.h5: damaged, or not a file of HDF5"},
      {"rm cut/fields.h5", "cannot open cut/fields.h5: No such file or directory"},
      {"cp other/fields.h5 cut", "cut/fields.h5 has [0-9]* snapshots before step .* at the checkpoint: it was changed"},
  };
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out other >/dev/null"), 0);
  cut_after(12);
  cr_assert_eq(shell("cp -r cut good"), 0);
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    cr_assert_eq(shell("rm -r cut; cp -r good cut; %s", all[k].change), 0);
    cr_expect_eq(shell("timeout 20 $DELBM resume cut --quiet >/dev/null 2>err"), 4, "%s", all[k].change);
    cr_expect_eq(shell("grep -q '%s' err || { cat err; false; }", all[k].said), 0);
    cr_expect_eq(shell("cmp good/fields/00000050.h5 cut/fields/00000050.h5"), 0);
  }
}

static long size_of(const char *path)
{
  struct stat found;
  cr_assert_eq(stat(path, &found), 0);
  return (long)found.st_size;
}

static void flip(const char *path, long at, int bit)
{
  FILE *file = fopen(path, "r+b");
  cr_assert(file && fseek(file, at, SEEK_SET) == 0);
  const int byte = fgetc(file);
  cr_assert(fseek(file, at, SEEK_SET) == 0 && fputc(byte ^ 1 << bit, file) >= 0 && fclose(file) == 0);
}

/* Where three numbers stand in a file for the first time. */
static long find(const char *path, const double numbers[3])
{
  static char bytes[1 << 20];
  FILE *file = fopen(path, "rb");
  cr_assert(file);
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  const char *at = memmem(bytes, size, numbers, 3 * sizeof *numbers);
  cr_assert(at && fclose(file) == 0);
  return at - bytes;
}

/* Numbers of discs are not deflated: nothing but their checksum tells. */
Test(fields, with_a_flipped_bit_in_the_radius_of_a_disc_are_refused)
{
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a --set output.checkpoint.every=110 >/dev/null"), 0);
  flip("a/fields.h5", find("a/fields.h5", (const double[]){9, 8, 8}) + 6, 3);
  cr_expect_eq(shell("$DELBM resume a --quiet --steps 260 >/dev/null 2>err"), 4);
  cr_expect_eq(shell("grep -q 'a/fields.h5: radius of step 0 is damaged or missing' err || { cat err; false; }"), 0);
}

/* What is not noticed must do no harm: bytes that mean nothing. */
Test(fields, with_a_flipped_bit_anywhere_are_refused_or_have_the_values_they_had)
{
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --out a --set run.steps=150 --set output.checkpoint.every=110 "
                     "--set domain.size=[125,100] --set output.fields.stride=7 >/dev/null && cp -r a good && "
                     "$DELBM resume a --quiet --steps 160 >/dev/null && cp a/fields.h5 whole.h5"),
               0);
  const long size = size_of("good/fields.h5");
  int refused = 0;
  for (long k = 0; k < 30; k++) {
    cr_assert_eq(shell("rm -r a; cp -r good a"), 0);
    flip("a/fields.h5", k * 7919 * 13 % size, (int)(k % 8));
    const int code = shell("$DELBM resume a --quiet --steps 160 >/dev/null 2>err");
    cr_expect(code == 0 || code == 4, "%ld: %d", k, code);
    refused += code == 4;
    if (code == 0) cr_expect_eq(shell("cmp a/fields.h5 whole.h5"), 0, "bit of byte %ld", k * 7919 * 13 % size);
  }
  cr_expect_gt(refused, 10, "%d of 30", refused);
}

Test(fields, of_other_samples_are_refused_on_resume_by_key_and_equal_samples_continue)
{
  static const struct {
    const char *from, *to, *said;
  } changes[] = {{"stride: 3", "stride: 2", "output.fields.stride is 2, but the snapshots in cut/fields.h5 have 3"},
                 {"region: \\[10,", "region: [13,", "output.fields.region gives 33 x 31 samples from cell (13, 5) on"},
                 {", 96\\]", ", 99]", "output.fields.region gives 34 x 32 samples from cell (10, 5) on"}};
  cr_assert_eq(shell("$DELBM run flow.yaml --quiet --set output.checkpoint.every=100 --out whole >/dev/null && "
                     "$DELBM run flow.yaml --quiet --set run.steps=150 --set output.checkpoint.every=100 --out cut "
                     ">/dev/null && cp cut/case.yaml ."),
               0);
  for (size_t k = 0; k < sizeof changes / sizeof changes[0]; k++) {
    cr_assert_eq(shell("sed 's/%s/%s/' case.yaml >cut/case.yaml; cmp -s case.yaml cut/case.yaml", changes[k].from,
                       changes[k].to),
                 1);
    cr_expect_eq(shell("$DELBM resume cut --quiet --steps 250 2>err"), 3);
    cr_expect_eq(shell("grep -qF '%s' err || { cat err; false; }", changes[k].said), 0);
  }
  cr_expect_eq(shell("cp case.yaml cut && $DELBM resume cut --quiet --steps 250 >/dev/null"), 0);
}

Test(fields, that_do_not_fit_on_the_disk_leave_the_earlier_ones)
{
  if (shell("unshare -m mount -t tmpfs tmpfs /mnt 2>/dev/null") != 0) cr_skip_test("mounting needs root");
  cr_assert_eq(
      shell("$DELBM run flow.yaml --set output.fields.every=10 --set output.checkpoint.every=10 --quiet --out whole "
            ">/dev/null && mkdir disk"),
      0);
  cr_expect_eq(
      shell("unshare -m sh -c 'mount -t tmpfs -o size=2600k tmpfs disk && "
            "$DELBM run flow.yaml --set output.fields.every=10 --set output.checkpoint.every=10 --quiet --out disk/cut "
            ">out 2>err; test $? = 4 || exit 9; "
            "mount -o remount,size=20000k disk && $DELBM resume disk/cut --quiet >/dev/null || exit 7; "
            "cmp whole/fields.h5 disk/cut/fields.h5 && cmp whole/fields.xdmf disk/cut/fields.xdmf'"),
      0);
  cr_expect_eq(shell("grep -qE '^delbm: cannot write disk/cut/.*: No space left on device$' err"), 0);
}

/* Limit on file sizes, in blocks of 512 bytes: between the sizes of a checkpoint and of the joined file. */
Test(fields, that_cannot_be_joined_stay_whole_and_a_resumed_run_joins_them)
{
  static const char *const run = "run flow.yaml --set output.fields.every=5 --set output.checkpoint.every=100 --quiet";
  cr_assert_eq(shell("$DELBM %s --out whole >/dev/null", run), 0);
  cr_expect_eq(shell("ulimit -f 2600; $DELBM %s --out cut >out 2>err", run), 4);
  cr_expect_eq(
      shell("grep -q '^delbm: cannot write cut/fields.h5: File too large; the snapshots are whole, but not in one "
            "file: cut/fields.h5 refers to those in cut/fields$' err && grep -q status=failed out && "
            "! ls cut/*.tmp 2>/dev/null && test $(ls cut/fields | wc -l) = 51 || { cat err; false; }"),
      0);
  cr_expect_eq(count_links("cut/fields.h5", H5L_TYPE_EXTERNAL), 51);
  cr_expect_eq(
      shell("$DELBM resume cut --quiet >/dev/null && cmp whole/fields.h5 cut/fields.h5 && test ! -e cut/fields"), 0);
}

#else

TestSuite(fields, .init = shell_enter, .fini = shell_leave);

Test(fields, are_refused_by_a_build_without_hdf5)
{
  shell_write("flow.yaml", "domain: {size: [8, 8]}\nfluid: {viscosity: 0.1}\nrun: {steps: 3}\n"
                           "output: {fields: {every: 1}}\n");
  cr_expect_eq(shell("$DELBM run flow.yaml --out a 2>err"), 3);
  cr_expect_eq(shell("grep -q 'output.fields.every is 1, but this build has no HDF5' err && test ! -e a"), 0);
}

#endif
