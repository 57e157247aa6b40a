// An extinction or optical depth: three numbers where COLOURED_SMOKE says that some medium takes more of one channel than of
// another, one where none does.
#ifdef COLOURED_SMOKE
#define Extinction vec3
#else
#define Extinction float
#endif
