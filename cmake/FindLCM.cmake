# LCM: the target lcm::lcm, and LCM_GEN, the program that makes bindings of message types. Installed beside
# DanceGraphConfig.cmake too. Debian's LCM has no CMake package, and its pkg-config file needs glib's headers, which it does
# not bring: so the files themselves are looked for.
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
find_program(LCM_GEN lcm-gen)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM
  REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN
  REASON_FAILURE_MESSAGE "install it with: apt-get install liblcm-dev liblcm-bin")
if(LCM_FOUND AND NOT TARGET lcm::lcm)
  add_library(lcm::lcm UNKNOWN IMPORTED)
  set_target_properties(lcm::lcm PROPERTIES
    IMPORTED_LOCATION "${LCM_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)
