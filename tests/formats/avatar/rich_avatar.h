// Tiny avatars with one of everything that the reader knows: what hostile files are made of, and
// the corpus of the fuzz target.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include "tests/formats/avatar/tiny_avatar.h"

namespace dance::test {

TinyAvatar rich_vrm1();  // skin, morphs, sparse and interleaved data, three pictures, springs
TinyAvatar rich_vrm0();  // the same by the extensions of VRM 0.x
TinyAvatar plain_glb();  // bones by Mixamo's names, a mesh without a skin, nothing else

}  // namespace dance::test
