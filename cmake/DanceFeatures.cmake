# Finds what the tree needs and prints, at the end of configuring, what is built, what is missing and which Debian
# package brings it.
include_guard(GLOBAL)
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)

set(DANCE_FEATURE_TABLE "" CACHE INTERNAL "")
function(dance_feature name state package)
  set(DANCE_FEATURE_TABLE "${DANCE_FEATURE_TABLE};${name}|${state}|${package}" CACHE INTERNAL "")
endfunction()

# dance_require(<what> <found-variable> <package>): a needed part; one line with the cure where it is missing.
function(dance_require what found package)
  if(NOT ${found})
    message(FATAL_ERROR "${what} is missing. Install it with: apt-get install ${package}   (or run ./dance, which does)")
  endif()
  dance_feature("${what}" "found" "${package}")
endfunction()

find_package(LCM QUIET MODULE)
dance_require("LCM" LCM_FOUND "liblcm-dev liblcm-bin")

find_package(Eigen3 3.4 QUIET NO_MODULE)
dance_require("Eigen 3.4" Eigen3_FOUND "libeigen3-dev")
find_package(tl-expected QUIET)
dance_require("tl::expected" tl-expected_FOUND "libexpected-dev")
find_package(tomlplusplus QUIET)
dance_require("toml++" tomlplusplus_FOUND "libtomlplusplus-dev")
find_package(CLI11 QUIET)
dance_require("CLI11" CLI11_FOUND "libcli11-dev")
find_package(nlohmann_json QUIET)
dance_require("nlohmann-json" nlohmann_json_FOUND "nlohmann-json3-dev")
find_package(spdlog QUIET)
dance_require("spdlog" spdlog_FOUND "libspdlog-dev")
find_package(OpenSSL 3 QUIET)
dance_require("OpenSSL 3" OPENSSL_FOUND "libssl-dev")
find_package(LibLZMA QUIET)
dance_require("liblzma" LIBLZMA_FOUND "liblzma-dev")

# dance_plain_library(<name> <header> <found-variable>): a library without a package for CMake or pkg-config: the header
# and lib<name> themselves, as the target <name>::<name>.
function(dance_plain_library name header found)
  string(TOUPPER ${name} upper)
  find_path(${upper}_INCLUDE_DIR ${header})
  find_library(${upper}_LIBRARY ${name})
  set(${found} FALSE PARENT_SCOPE)
  if(${upper}_INCLUDE_DIR AND ${upper}_LIBRARY)
    set(${found} TRUE PARENT_SCOPE)
    add_library(dance_${name} INTERFACE)
    add_library(${name}::${name} ALIAS dance_${name})
    target_include_directories(dance_${name} SYSTEM INTERFACE ${${upper}_INCLUDE_DIR})
    target_link_libraries(dance_${name} INTERFACE ${${upper}_LIBRARY})
  endif()
endfunction()

# The protocols and files of others: OSC, LZ4 frames of Rokoko, zstd chunks of MCAP, glTF.
dance_plain_library(oscpack oscpack/osc/OscReceivedElements.h oscpack_found)
dance_require("oscpack" oscpack_found "liboscpack-dev")
pkg_check_modules(LZ4 QUIET IMPORTED_TARGET liblz4)
dance_require("LZ4" LZ4_FOUND "liblz4-dev")
pkg_check_modules(ZSTD QUIET IMPORTED_TARGET libzstd)
dance_require("zstd" ZSTD_FOUND "libzstd-dev")
dance_plain_library(tinygltf tiny_gltf.h tinygltf_found)
dance_require("tinygltf" tinygltf_found "libtinygltf-dev")
# Avatars that the project makes: their pictures, and meshes with fewer triangles.
pkg_check_modules(LIBPNG QUIET IMPORTED_TARGET libpng)
dance_require("libpng" LIBPNG_FOUND "libpng-dev")
dance_plain_library(meshoptimizer meshoptimizer.h meshoptimizer_found)
dance_require("meshoptimizer" meshoptimizer_found "libmeshoptimizer-dev")
# The pictures in avatars; the camera's too.
dance_plain_library(turbojpeg turbojpeg.h turbojpeg_found)
dance_require("libjpeg-turbo" turbojpeg_found "libturbojpeg0-dev")
dance_plain_library(webp webp/decode.h webp_found)
dance_require("libwebp" webp_found "libwebp-dev")

# Third-party headers are not ours to warn about.
foreach(target Eigen3::Eigen tl::expected tomlplusplus::tomlplusplus CLI11::CLI11 nlohmann_json::nlohmann_json)
  if(TARGET ${target})
    get_target_property(dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
    if(dirs)
      set_target_properties(${target} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${dirs}")
    endif()
  endif()
endforeach()

# dance_optional(<option> <what> <have-variable> <found> <package>): ON insists, OFF leaves out, AUTO takes what is there.
function(dance_optional option what have found package)
  set(${have} FALSE PARENT_SCOPE)
  if(${option} STREQUAL "OFF")
    dance_feature("${what}" "off" "${package}")
  elseif(found)
    set(${have} TRUE PARENT_SCOPE)
    dance_feature("${what}" "built" "${package}")
  elseif(${option} STREQUAL "ON")
    message(FATAL_ERROR "${what} was asked for (${option}=ON). Install it with: apt-get install ${package}")
  else()
    dance_feature("${what}" "missing" "${package}")
  endif()
endfunction()

find_package(glfw3 QUIET)
pkg_check_modules(EPOXY QUIET IMPORTED_TARGET epoxy)
pkg_check_modules(IMGUI QUIET IMPORTED_TARGET imgui)
pkg_check_modules(EGL QUIET IMPORTED_TARGET egl)
set(viewer_found FALSE)
if(glfw3_FOUND AND EPOXY_FOUND AND IMGUI_FOUND AND EGL_FOUND)
  set(viewer_found TRUE)
endif()
dance_optional(DANCE_VIEWER "Viewer" DANCE_HAVE_VIEWER ${viewer_found}
  "libglfw3-dev libepoxy-dev libimgui-dev libegl-dev")

# Headsets: the loader of OpenXR, which finds the runtime of the headset.
pkg_check_modules(OPENXR QUIET IMPORTED_TARGET openxr)
# Their pictures go to the runtime with a window of X11, whose headers libglfw3-dev and libepoxy-dev bring.
pkg_check_modules(X11 QUIET IMPORTED_TARGET x11)
dance_optional(DANCE_XR "Headsets" DANCE_HAVE_XR "${OPENXR_FOUND}" "libopenxr-dev")

pkg_check_modules(SNDFILE QUIET IMPORTED_TARGET sndfile)
dance_optional(DANCE_MUSIC "Music" DANCE_HAVE_MUSIC "${SNDFILE_FOUND}" "libsndfile1-dev")
# Music that libsndfile cannot read, videos in and out: a module that is loaded when it is wanted (formats/media). From
# FFmpeg 5.1 on, which has the channel layouts that are used.
pkg_check_modules(FFMPEG QUIET IMPORTED_TARGET libavformat>=59.27 libavcodec libavutil libswresample libswscale)
dance_optional(DANCE_FFMPEG "Media with FFmpeg" DANCE_HAVE_FFMPEG "${FFMPEG_FOUND}"
  "libavformat-dev libavcodec-dev libavutil-dev libswresample-dev libswscale-dev")
# The house band's instruments; they are in a module of their own (producers/music/band).
pkg_check_modules(FLUIDSYNTH QUIET IMPORTED_TARGET fluidsynth>=2.2)
dance_optional(DANCE_FLUIDSYNTH "Band's soundfonts" DANCE_HAVE_FLUIDSYNTH "${FLUIDSYNTH_FOUND}" "libfluidsynth-dev timgm6mb-soundfont")
pkg_check_modules(PULSE QUIET IMPORTED_TARGET libpulse)
dance_optional(DANCE_SOUND "Sound" DANCE_HAVE_SOUND "${PULSE_FOUND}" "libpulse-dev")

# Voices: their codec, and what takes echo and noise out of them.
pkg_check_modules(OPUS QUIET IMPORTED_TARGET opus)
pkg_search_module(WEBRTC QUIET IMPORTED_TARGET webrtc-audio-processing-1 webrtc-audio-processing) # Debian 13 and 12
set(voice_found FALSE)
if(PULSE_FOUND AND OPUS_FOUND AND WEBRTC_FOUND AND NOT DANCE_SOUND STREQUAL "OFF")
  set(voice_found TRUE)
endif()
dance_optional(DANCE_VOICE "Voice" DANCE_HAVE_VOICE ${voice_found} "libopus-dev libwebrtc-audio-processing-dev libpulse-dev")
pkg_check_modules(WEBSOCKETS QUIET IMPORTED_TARGET libwebsockets)
dance_optional(DANCE_BHAPTICS "Haptic suits" DANCE_HAVE_BHAPTICS "${WEBSOCKETS_FOUND}" "libwebsockets-dev")

# Of Debian's OpenCV the modules that are used, without the package that brings all of them and their CMake files.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
set(opencv_found ${OPENCV_INCLUDE_DIR})
add_library(dance_opencv INTERFACE)
add_library(opencv::opencv ALIAS dance_opencv)
foreach(module calib3d dnn imgproc core)
  find_library(OPENCV_${module}_LIBRARY opencv_${module})
  if(OPENCV_${module}_LIBRARY)
    target_link_libraries(dance_opencv INTERFACE ${OPENCV_${module}_LIBRARY})
  else()
    set(opencv_found FALSE)
  endif()
endforeach()
find_path(FLATBUFFERS_INCLUDE_DIR flatbuffers/flatbuffers.h)
find_program(FLATC flatc)
set(camera_found FALSE)
if(opencv_found AND FLATBUFFERS_INCLUDE_DIR AND FLATC)
  set(camera_found TRUE)
  target_include_directories(dance_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
endif()
dance_optional(DANCE_CAMERA "Camera" DANCE_HAVE_CAMERA ${camera_found}
  "libopencv-dnn-dev libopencv-calib3d-dev flatbuffers-compiler \
libflatbuffers-dev")

# Without it OpenCV runs the pose network: the same numbers, four times slower.
find_path(XNNPACK_INCLUDE_DIR xnnpack.h)
find_library(XNNPACK_LIBRARY XNNPACK)
find_path(PTHREADPOOL_INCLUDE_DIR pthreadpool.h)
find_library(PTHREADPOOL_LIBRARY pthreadpool)
set(xnnpack_found FALSE)
if(XNNPACK_INCLUDE_DIR AND XNNPACK_LIBRARY AND PTHREADPOOL_INCLUDE_DIR AND PTHREADPOOL_LIBRARY)
  set(xnnpack_found TRUE)
  add_library(dance_xnnpack INTERFACE)
  add_library(xnnpack::xnnpack ALIAS dance_xnnpack)
  target_include_directories(dance_xnnpack SYSTEM INTERFACE ${XNNPACK_INCLUDE_DIR} ${PTHREADPOOL_INCLUDE_DIR})
  target_link_libraries(dance_xnnpack INTERFACE ${XNNPACK_LIBRARY} ${PTHREADPOOL_LIBRARY})
  file(STRINGS ${XNNPACK_INCLUDE_DIR}/xnnpack.h unary REGEX "xnn_define_unary")
  if(unary)
    target_compile_definitions(dance_xnnpack INTERFACE DANCE_XNNPACK_HAS_UNARY=1)
  endif()
endif()
dance_optional(DANCE_XNNPACK "Fast pose network" DANCE_HAVE_XNNPACK ${xnnpack_found} "libxnnpack-dev libpthreadpool-dev")

find_package(GTest QUIET)
set(gtest_found FALSE)
if(GTest_FOUND)
  set(gtest_found TRUE)
  include(GoogleTest)
endif()
dance_optional(DANCE_TESTS "Tests" DANCE_HAVE_TESTS ${gtest_found} "libgtest-dev")

find_package(benchmark QUIET)
set(benchmark_found FALSE)
if(benchmark_FOUND)
  set(benchmark_found TRUE)
endif()
dance_optional(DANCE_BENCH "Benchmarks" DANCE_HAVE_BENCH ${benchmark_found} "libbenchmark-dev")

dance_plain_library(enet enet/enet.h enet_found)
dance_optional(DANCE_ENET "ENet to compare with" DANCE_HAVE_ENET ${enet_found} "libenet-dev")

# Through pkg-config: the package of CMake insists on all that the library could be built with.
pkg_check_modules(PROMETHEUS QUIET IMPORTED_TARGET prometheus-cpp-pull)
dance_optional(DANCE_PROMETHEUS "Server metrics" DANCE_HAVE_PROMETHEUS "${PROMETHEUS_FOUND}"
  "prometheus-cpp-dev")

# Invitations that a phone's camera reads.
pkg_check_modules(QRENCODE QUIET IMPORTED_TARGET libqrencode)
dance_optional(DANCE_QR "QR codes" DANCE_HAVE_QR "${QRENCODE_FOUND}" "libqrencode-dev")

pkg_check_modules(NATS QUIET IMPORTED_TARGET libnats)
dance_optional(DANCE_NATS "Servers in clusters" DANCE_HAVE_NATS "${NATS_FOUND}" "libnats-dev")

# Limits the threads that read strangers' files to reading (core/program/confinement.h).
pkg_check_modules(SECCOMP QUIET IMPORTED_TARGET libseccomp)
dance_optional(DANCE_SECCOMP "Confined readers" DANCE_HAVE_SECCOMP "${SECCOMP_FOUND}" "libseccomp-dev")

find_program(JAVAC javac)
find_program(JAR jar)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java /usr/local/share/java)
set(spy_found FALSE)
if(JAVAC AND JAR AND LCM_JAR)
  set(spy_found TRUE)
endif()
dance_optional(DANCE_SPY_TYPES "Types for lcm-spy" DANCE_HAVE_SPY_TYPES ${spy_found}
  "liblcm-java libjchart2d-java default-jdk")

function(dance_print_features)
  message(STATUS "")
  message(STATUS "DanceGraph ${PROJECT_VERSION}: what is built")
  foreach(row IN LISTS DANCE_FEATURE_TABLE)
    if(row)
      string(REPLACE "|" ";" cells "${row}")
      list(GET cells 0 name)
      list(GET cells 1 state)
      list(GET cells 2 package)
      string(SUBSTRING "${name}                    " 0 20 name)
      string(SUBSTRING "${state}        " 0 8 state)
      message(STATUS "  ${name} ${state}  apt: ${package}")
    endif()
  endforeach()
  message(STATUS "")
endfunction()
