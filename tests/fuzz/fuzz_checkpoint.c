/* Fuzz target: the reader of checkpoints. The input is a checkpoint of the small case below, whose checksum is put right
 * here, so that what lies behind it is reached: a state that is restored must be able to go on, or to say why not. The
 * first byte of the input is not part of it: if odd, the checksum stays as it is. */
#include "input.h"

#include "output/checkpoint.h"
#include "scenes.h"

#include <string.h>
#include <zlib.h>

enum { FINGERPRINT = 1 };

/* Discs of each motion, in contact and not, one of them light, in a box with walls and periodic sides. Sub-steps are fixed:
 * a state that makes contacts stiff could otherwise ask for a million of them, a second each. */
static struct scene small_case(void)
{
  struct scene scene = scene_box(16, 8, 0.1, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -1e-3;
  scene.contact.substeps = 4;
  scene_add_disc(&scene, 1.5, 1.5, 4, 3);
  scene_add_disc(&scene, 1, 0.2, 6.4, 3);
  scene_add_disc(&scene, 1, 1, 10, 4)->motion = DISC_FIXED;
  struct disc_spec *driven = scene_add_disc(&scene, 1, 1, 14, 5);
  driven->motion = DISC_DRIVEN;
  driven->velocity[0] = 0.01;
  return scene;
}

static void put_right(uint8_t *bytes, size_t size)
{
  const uint32_t sum = (uint32_t)crc32_z(0, bytes, size - sizeof sum);
  memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
}

static bool read_and_go_on(const char *path, struct status *status)
{
  struct scene scene = small_case();
  struct simulation *simulation;
  struct run_record record;
  if (!simulation_create(&simulation, &scene, status)) abort();
  const bool restored = checkpoint_read(path, simulation, &record, status);
  if (restored) simulation_advance(simulation, 2, status);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return restored;
}

/* Most inputs are refused by their head: those need no simulation, whose making takes most of the time. */
static bool examine_and_read(const char *path)
{
  struct checkpoint_head head;
  struct status status = {0};
  const bool restored = checkpoint_examine(path, FINGERPRINT, &head, &status) && read_and_go_on(path, &status);
  if (!restored && strlen(status.message) == 0) abort();
  return restored;
}

/* With DELBM_SEED set, writes a checkpoint to that path instead: the corpus. It is one that can be restored. */
static void write_seed(const char *path)
{
  struct scene scene = small_case();
  struct simulation *simulation;
  struct status status;
  const struct run_record record = {.discs_bytes = 100, .seconds = 1, .output = 0.1};
  if (!simulation_create(&simulation, &scene, &status) || !simulation_advance(simulation, 7, &status) ||
      !checkpoint_write(path, FINGERPRINT, simulation, &record, &status)) {
    fprintf(stderr, "%s\n", status.message);
    abort();
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  if (!examine_and_read(path)) abort();
}

int LLVMFuzzerInitialize(int *argc, char ***argv);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  const char *seed = getenv("DELBM_SEED");
  if (!seed) return 0;
  write_seed(seed);
  exit(0);
}

size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t most, unsigned seed);

/* Three times of four, bytes are changed in place: a state of another length is refused before any of it is looked at. */
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
  enum { WINDOW = 16 };
  if (seed % 4 == 0 || size < WINDOW) return LLVMFuzzerMutate(bytes, size, most);
  const size_t at = seed / 4 % (size - WINDOW + 1);
  uint8_t window[WINDOW];
  memcpy(window, bytes + at, WINDOW);
  LLVMFuzzerMutate(window, WINDOW, WINDOW);
  memcpy(bytes + at, window, WINDOW);
  return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  if (size < 1 + sizeof(uint32_t)) return 0;
  uint8_t *copy = malloc(size - 1);
  if (!copy) abort();
  memcpy(copy, bytes + 1, size - 1);
  if (bytes[0] % 2 == 0) put_right(copy, size - 1);
  char path[INPUT_PATH];
  const int descriptor = input_file(copy, size - 1, path);
  examine_and_read(path);
  close(descriptor);
  free(copy);
  return 0;
}
