// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/texture_files.h"

#include "io/files.h"
#include "osteon/io/load.h"

namespace osteon::io {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(TextureFiles, are_those_of_an_objs_materials_that_are_there) {
  const TemporaryFolder folder;
  write(folder / "red.png", "picture");
  write(folder / "a.mtl", "newmtl a\nmap_Kd red.png\nnewmtl b\nmap_Kd missing.png\nnewmtl c\nKd 1 0 0\n");
  const Asset asset = load(write(folder / "a.obj",
                                 "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 3/1 2/1\n"
                                 "usemtl c\nf 1/1 2/1 3/1\n"));
  EXPECT_THAT(texture_files(asset), ElementsAre(folder / "red.png"));
}

TEST(TextureFiles, are_a_gltfs_images_beside_it) {
  const TemporaryFolder folder;
  write(folder / "my skin.png", "picture");
  gltf::Document document = tetrahedron_document();
  EXPECT_THAT(texture_files(load(write_document(folder / "within.glb", document))), IsEmpty());
  document.json["images"] =
      gltf::Json::parse(R"([{"uri": "my%20skin.png"}, {"uri": "data:image/png;base64,AAAA"}, {"uri": "missing.png"}])");
  EXPECT_THAT(texture_files(load(write_document(folder / "beside.glb", document))), ElementsAre(folder / "my skin.png"));
}

}  // namespace
}  // namespace osteon::io
