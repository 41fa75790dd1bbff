// A small BVH text and files of tests/formats/bvh/data, for the BVH and retargeting tests.
//
// Threads: none inside.
// Failure: sample() of a missing file is empty, which no reader takes for a BVH.
#pragma once

#include <string>

#include "tests/test_folder.h"

namespace dance::test {

constexpr const char* kTwoJoints =
    "HIERARCHY\n"
    "ROOT hips\n"
    "{\n"
    "\tOFFSET 0 0 0\n"
    "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "\tJOINT spine\n"
    "\t{\n"
    "\t\tOFFSET 0 10 0\n"
    "\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
    "\t\tEnd Site\n"
    "\t\t{\n"
    "\t\t\tOFFSET 0 5 0\n"
    "\t\t}\n"
    "\t}\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.0333333\n"
    "1 2 3 4 5 6 7 8 9\n"
    "-1 -2 -3 -4 -5 -6 -7 -8 -9\n";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

inline std::string sample(const std::string& name) {
  return text_of(DANCE_SOURCE_DIR "/tests/formats/bvh/data/" + name + ".bvh");
}

}  // namespace dance::test
