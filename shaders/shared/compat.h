// Lets one header be read by C++ and by GLSL (scalar block layout on the device).
#ifndef LUCERNA_SHARED_COMPAT_H
#define LUCERNA_SHARED_COMPAT_H
#ifdef __cplusplus
#include "base/math.h"
#define LUCERNA_SHARED_BEGIN namespace lucerna::shared {
#define LUCERNA_SHARED_END }
typedef uint32_t uint;
#define LUCERNA_CONST inline constexpr
#define LUCERNA_INLINE inline
#else
#define LUCERNA_SHARED_BEGIN
#define LUCERNA_SHARED_END
#define LUCERNA_CONST const
#define LUCERNA_INLINE
#endif
#endif
