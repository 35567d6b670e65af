/* What the tests do in a way of its own on each platform. */
#ifndef FOCAL_TEST_PORTABLE_H
#define FOCAL_TEST_PORTABLE_H

#include <errno.h>
#include <stdlib.h>

#ifdef _WIN32
#include <direct.h>

static inline int make_folder(const char* path) { return _mkdir(path) == 0 || errno == EEXIST; }
static inline int remove_folder(const char* path) { return _rmdir(path) == 0; }
static inline int set_variable(const char* name, const char* value) { return _putenv_s(name, value) == 0; }
#else
#include <sys/stat.h>
#include <unistd.h>

static inline int make_folder(const char* path) { return mkdir(path, 0700) == 0 || errno == EEXIST; }
static inline int remove_folder(const char* path) { return rmdir(path) == 0; }
static inline int set_variable(const char* name, const char* value) { return setenv(name, value, 1) == 0; }
#endif

#endif
