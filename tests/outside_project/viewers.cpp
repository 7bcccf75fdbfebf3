// Uses the installed viewers once: the colour of an event is that of the pictures.

#include <viewers/palette.h>

#include <cstdio>

int main() {
  const auto colour = sightline::viewers::hex(sightline::viewers::colour_of_kind("EV"));
  std::printf("EV arcs are %s\n", colour.c_str());
  return colour.size() == 7 ? 0 : 1;
}
