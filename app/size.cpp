#include "app/size.h"

#include <cstdio>

#include "base/error.h"
#include "film/film.h"

namespace lucerna::app {

std::pair<uint32_t, uint32_t> parse_size(const std::string& text) {
  unsigned long w = 0, h = 0;
  char rest = 0;
  if (text.find('-') != std::string::npos || std::sscanf(text.c_str(), "%lux%lu%c", &w, &h, &rest) != 2 ||
      !w || !h || w > film::k_max_side || h > film::k_max_side)
    throw_error("--size", "'{}': expected WIDTHxHEIGHT, each from 1 to {}, such as 1280x720", text,
                film::k_max_side);
  return {uint32_t(w), uint32_t(h)};
}

}  // namespace lucerna::app
