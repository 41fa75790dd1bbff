// DanceAdapter.hpp in a program that is linked with the library, and compiled without exceptions.
#define DANCE_ADAPTER_LINKED
#include "bindings/unreal/DanceAdapter.hpp"

std::uint32_t count_dancers(const char* house);

std::uint32_t count_dancers(const char* house) {
  const dancegraph::Library library;
  dancegraph::Adapter adapter(library, house, DANCE_AXES_UNREAL);
  dancegraph::GuestList guests;
  adapter.guests(guests);
  return guests.count;
}
