/* Saves that fail: every call of every kind of save fails in turn, is interrupted or writes little; and the process is
 * killed before and after each of them. The file is a whole old or a whole new one each time.
 * usage: files [KILLS], default 200 */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "file_calls.h"
#include "fixture.h"

enum { OLD_BYTES = 30000, WRITES = 24 };

typedef focal_status (*save_fn)(const void* from, const char* path);
typedef struct saver {
  const char* name;
  save_fn save;
  const void* from;
  const char* file;
} saver;

typedef struct content {
  unsigned char* bytes;
  size_t size;
} content;

typedef struct tally {
  long faults, refused, after_rename, handled, torn, left, other, open_files;
} tally;

static focal_status save_model(const void* from, const char* path) { return focal_model_save(from, path); }
static focal_status save_analysis(const void* from, const char* path) {
  return focal_analysis_save(from, path);
}
static focal_status save_landmarks(const void* from, const char* path) {
  return focal_detection_write_gltf(from, path);
}
static focal_status save_votes(const void* from, const char* path) {
  return focal_detection_write_votes_gltf(from, path);
}
static focal_status save_segments(const void* from, const char* path) {
  return focal_detection_write_segments_gltf(from, FOCAL_SEGMENTATION_AUTO, path);
}
static focal_status save_skeleton(const void* from, const char* path) {
  return focal_skeleton_write_gltf(from, path);
}

static content read_all(const char* path) {
  content all = {malloc(1 << 20), 0};
  FILE* file = fopen(path, "rb");
  if (!all.bytes || !file) exit(2);
  all.size = fread(all.bytes, 1, 1 << 20, file);
  fclose(file);
  return all;
}

static void write_old(const char* path, const content* old) {
  FILE* file = fopen(path, "wb");
  if (!file || fwrite(old->bytes, 1, old->size, file) != old->size || fclose(file) != 0) exit(2);
}

static int holds(const char* path, const content* expected) {
  const content now = read_all(path);
  const int same = now.size == expected->size && memcmp(now.bytes, expected->bytes, now.size) == 0;
  free(now.bytes);
  return same;
}

/* Temporary files in the folder, and takes them away. */
static int clear_temporaries(const char* folder) {
  DIR* const all = opendir(folder);
  int count = 0;
  for (const struct dirent* one; all && (one = readdir(all));) {
    char path[1024];
    if (!strstr(one->d_name, ".tmp")) continue;
    snprintf(path, sizeof path, "%s/%s", folder, one->d_name);
    unlink(path);
    ++count;
  }
  closedir(all);
  return count;
}

static int open_files(void) {
  DIR* const all = opendir("/proc/self/fd");
  int count = 0;
  while (all && readdir(all)) ++count;
  closedir(all);
  return count;
}

static void complain(const saver* what, const file_plan* plan, const char* why, focal_status status) {
  fprintf(stderr, "%s, call %ld, errno %d, %d interruptions: %s (%s: %s)\n", what->name, (long)plan->fail_at,
          plan->error, plan->interruptions, why, focal_status_name(status), focal_last_error());
}

static void fault(const fixture* f, const saver* what, const content* old, const content* new, file_plan plan,
                  tally* sum) {
  char path[512];
  snprintf(path, sizeof path, "%s", fixture_path(f, what->file));
  write_old(path, old);
  const int files = open_files();
  file_calls_begin(plan);
  const focal_status status = what->save(what->from, path);
  file_calls_end();
  const int renamed = file_calls_renamed();
  ++sum->faults;
  if (status == FOCAL_OK)
    ++sum->handled;
  else if (status == FOCAL_ERROR_IO && renamed)
    ++sum->after_rename;
  else if (status == FOCAL_ERROR_IO)
    ++sum->refused;
  else
    ++sum->other, complain(what, &plan, "another status", status);
  if (!holds(path, renamed ? new : old) || (status == FOCAL_OK && !renamed))
    ++sum->torn, complain(what, &plan, "neither the old file nor the new one", status);
  if (clear_temporaries(f->folder) > 0)
    ++sum->left, complain(what, &plan, "a temporary file is left", status);
  if (open_files() != files) ++sum->open_files, complain(what, &plan, "a file stays open", status);
}

static void fault_each(const fixture* f, const saver* what, const content* old, const content* new,
                       tally* sum) {
  static const int errors[] = {ENOSPC, EIO, EDQUOT, EROFS, EINTR, 0};
  const size_t few = new->size / WRITES + 1;
  file_calls_begin((file_plan){.longest_write = few});
  what->save(what->from, fixture_path(f, what->file));
  const int64_t calls = file_calls_end();
  for (size_t e = 0; e < sizeof errors / sizeof *errors; ++e)
    for (int64_t n = 1; n <= calls; ++n)
      fault(f, what, old, new, (file_plan){.fail_at = n, .error = errors[e], .longest_write = few}, sum);
  for (int times = 1; times <= 50; times += 7)
    fault(f, what, old, new, (file_plan){.interruptions = times, .longest_write = few}, sum);
  for (size_t most = 1; most < 4096; most *= 5)
    fault(f, what, old, new, (file_plan){.longest_write = most}, sum);
}

/* Kills before and after each call of one save, which writes so little at a time that there are at least `kills`. */
static int kill_each(const fixture* f, const saver* what, const content* old, const content* new,
                     long kills) {
  char path[512];
  snprintf(path, sizeof path, "%s", fixture_path(f, what->file));
  const size_t few = new->size / (size_t)(kills / 2);
  file_calls_begin((file_plan){.longest_write = few});
  what->save(what->from, path);
  const int64_t points = 2 * file_calls_end();
  long olds = 0, news = 0, torn = 0;
  for (int64_t point = 1; point <= points; ++point) {
    write_old(path, old);
    const pid_t child = fork();
    if (child == 0) {
      file_calls_begin((file_plan){.longest_write = few, .die_at = point});
      what->save(what->from, path);
      _exit(0);
    }
    int result = 0;
    waitpid(child, &result, 0);
    if (!WIFSIGNALED(result) || WTERMSIG(result) != SIGKILL)
      ++torn, fprintf(stderr, "point %ld was not met\n", (long)point);
    else if (holds(path, old))
      ++olds;
    else if (holds(path, new))
      ++news;
    else
      ++torn;
    clear_temporaries(f->folder);
  }
  printf("%-10s %ld kills: %ld old, %ld new, %ld torn\n", what->name, olds + news + torn, olds, news, torn);
  return torn != 0 || olds + news < kills;
}

int main(int argc, char** argv) {
  const long kills = argc > 1 ? atol(argv[1]) : 200;
  fixture f;
  focal_context_params params;
  focal_skeleton* skeleton = NULL;
  focal_context_params_init(&params, sizeof params);
  params.thread_count = 1;
  fixture_create(&f, 7, &params);
  if (focal_skeleton_create(f.rig_detection, NULL, NULL, &skeleton) != FOCAL_OK) return 2;
  const saver savers[] = {{"model", save_model, f.model, "out.focal"},
                          {"analysis", save_analysis, f.analysis, "out.analysis"},
                          {"landmarks", save_landmarks, f.detection, "out.glb"},
                          {"votes", save_votes, f.detection, "out.glb"},
                          {"segments", save_segments, f.detection, "out.glb"},
                          {"skeleton", save_skeleton, skeleton, "out.glb"}};
  content old = {calloc(OLD_BYTES, 1), OLD_BYTES};
  if (!old.bytes) return 2;
  for (size_t i = 0; i < OLD_BYTES; ++i) old.bytes[i] = (unsigned char)(i * 31);
  tally sum = {0};
  int bad = 0;
  for (size_t s = 0; s < sizeof savers / sizeof *savers; ++s) {
    if (savers[s].save(savers[s].from, fixture_path(&f, savers[s].file)) != FOCAL_OK) return 2;
    content new = read_all(fixture_path(&f, savers[s].file));
    fault_each(&f, &savers[s], &old, &new, &sum);
    bad |= kill_each(&f, &savers[s], &old, &new, kills);
    free(new.bytes);
  }
  printf(
      "%ld faults: %ld IO and the old file, %ld IO after the rename and the new file, %ld handled, %ld other "
      "answers, "
      "%ld torn, %ld temporary files left, %ld left open\n",
      sum.faults, sum.refused, sum.after_rename, sum.handled, sum.other, sum.torn, sum.left, sum.open_files);
  free(old.bytes);
  focal_skeleton_destroy(skeleton);
  fixture_destroy(&f);
  return bad || sum.torn || sum.left || sum.other || sum.open_files;
}
