// As emmintrin.h.
#include <emmintrin.h>
