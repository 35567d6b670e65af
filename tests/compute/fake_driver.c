/* What the loader asks of libcuda.so.1, answered as the macros say. */
int cuInit(unsigned flags) {
  (void)flags;
  return START;
}
int cuDriverGetVersion(int* version) {
  *version = VERSION;
  return 0;
}
int cuDeviceGetCount(int* count) {
  *count = DEVICES;
  return 0;
}
