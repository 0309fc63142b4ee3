#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What a COLLADA file of one square from (0, 0, 0) to (1, 1, 0) says.
struct DaeContent {
  std::string asset = "<unit name='meter' meter='1'/><up_axis>Z_UP</up_axis>";
  std::string node = "<translate>0 0 0</translate>";
  std::string effect = "<lambert><diffuse><color>0.8 0.1 0.2 1</color></diffuse></lambert>";
  std::string parameters{};  ///< of the effect's profile
  std::string sections{};    ///< of the file
  std::string instance = "instance_geometry url='#g'";
};

std::string dae(const DaeContent& content) {
  const std::string element = content.instance.substr(0, content.instance.find(' '));
  return "<?xml version='1.0' encoding='utf-8'?>\n"
         "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>" +
         content.asset + "</asset>" + content.sections +
         "<library_effects><effect id='e'><profile_COMMON>" + content.parameters +
         "<technique sid='common'>" + content.effect +
         "</technique></profile_COMMON></effect></library_effects>"
         "<library_materials><material id='m' name='label'><instance_effect url='#e'/></material>"
         "</library_materials><library_geometries><geometry id='g' name='g'><mesh>"
         "<source id='p'><float_array id='pa' count='12'>0 0 0 1 0 0 1 1 0 0 1 0</float_array>"
         "<technique_common><accessor source='#pa' count='4' stride='3'><param name='X' "
         "type='float'/><param name='Y' type='float'/><param name='Z' type='float'/></accessor>"
         "</technique_common></source>"
         "<source id='t'><float_array id='ta' count='8'>0 0 2 0 2 2 0 2</float_array>"
         "<technique_common><accessor source='#ta' count='4' stride='2'><param name='S' "
         "type='float'/><param name='T' type='float'/></accessor></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
         "<triangles material='mm' count='2'><input semantic='VERTEX' source='#v' offset='0'/>"
         "<input semantic='TEXCOORD' source='#t' offset='1' set='0'/>"
         "<p>0 0 1 1 2 2 0 0 2 2 3 3</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id='s'><node id='n' name='n'>" +
         content.node + "<" + content.instance +
         "><bind_material><technique_common><instance_material symbol='mm' target='#m'>"
         "<bind_vertex_input semantic='UVMap' input_semantic='TEXCOORD' input_set='0'/>"
         "</instance_material></technique_common></bind_material></" +
         element +
         "></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

constexpr const char* kTextured =
    "<lambert><diffuse><texture texture='sampler' texcoord='UVMap'/></diffuse></lambert>";
constexpr const char* kSampler =
    "<newparam sid='surface'><surface type='2D'><init_from>i</init_from></surface></newparam>"
    "<newparam sid='sampler'><sampler2D><source>surface</source><wrap_s>MIRROR</wrap_s>"
    "<wrap_t>CLAMP</wrap_t></sampler2D></newparam>";
constexpr const char* kImages =
    "<library_images><image id='i'><init_from>my%20picture.png</init_from></image>"
    "</library_images>";

class DaeFile : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& bytes) {
    return write_file(folder_.path() / "a.dae", bytes);
  }
  ImportedMesh import(const DaeContent& content) { return import_mesh(file(dae(content))); }
  std::vector<std::string> notes(const DaeContent& content) {
    std::vector<std::string> out;
    for (const std::string& note : import(content).notes)
      out.push_back(note.substr((folder_.path() / "a.dae: ").string().size()));
    return out;
  }
  TemporaryDirectory folder_;
};

TEST_F(DaeFile, HasItsColorAndNoNotes) {
  const ImportedMesh imported = import({});
  EXPECT_EQ(imported.mesh.vertices.cols(), 4);
  EXPECT_EQ(imported.mesh.color, Eigen::Vector3f(0.8f, 0.1f, 0.2f));
  EXPECT_TRUE(imported.bones.empty());
  EXPECT_THAT(imported.notes, IsEmpty());
}

TEST_F(DaeFile, IsPlacedByItsNodesInMetres) {
  const Mesh mesh =
      import({.asset = "<unit name='centimeter' meter='0.01'/><up_axis>Z_UP</up_axis>",
              .node = "<translate>5 0 7</translate><rotate>0 0 1 90</rotate>"})
          .mesh;
  const Eigen::Vector3f low = mesh.vertices.rowwise().minCoeff();
  const Eigen::Vector3f high = mesh.vertices.rowwise().maxCoeff();
  EXPECT_LT((low - Eigen::Vector3f(0.04f, 0, 0.07f)).norm(), 1e-6f) << low.transpose();
  EXPECT_LT((high - Eigen::Vector3f(0.05f, 0.01f, 0.07f)).norm(), 1e-6f) << high.transpose();
}

TEST_F(DaeFile, UpAxisTurnsNothing) {
  const ImportedMesh imported = import({.asset = "<up_axis>Y_UP</up_axis>"});
  EXPECT_EQ(imported.mesh.vertices.row(2).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(imported.mesh.vertices.rowwise().maxCoeff(), Eigen::Vector3f(1, 1, 0));
  EXPECT_THAT(imported.notes,
              ElementsAre(HasSubstr("its <up_axis> Y_UP turns nothing, as in RViz")));
}

TEST_F(DaeFile, TellsWhatIsTakenWhereItDoesNotSay) {
  EXPECT_THAT(import({.asset = "<unit name='inch' meter='0.0254'/>"}).notes,
              ElementsAre(HasSubstr("it has no <up_axis>, which means Y_UP; that turns nothing")));
  const ImportedMesh imported =
      import({.asset = "<unit name='centimeter'/><up_axis>Z_UP</up_axis>"});
  EXPECT_THAT(imported.notes,
              ElementsAre(HasSubstr("its <unit name=\"centimeter\"> has no `meter`, so its "
                                    "coordinates are metres")));
}

TEST_F(DaeFile, HasItsPictureWithItsWrap) {
  cv::Mat3b picture(4, 4, cv::Vec3b(0, 0, 200));
  picture({2, 0, 2, 2}).setTo(cv::Vec3b(0, 200, 0));  // the upper right is green
  const std::vector<unsigned char> bytes = encode_image(".png", picture);
  write_file(folder_.path() / "my picture.png", std::string(bytes.begin(), bytes.end()));
  const ImportedMesh imported =
      import({.effect = kTextured, .parameters = kSampler, .sections = kImages});
  const Eigen::Vector3f red(200, 0, 0), green(0, 200, 0);
  EXPECT_EQ(surface_color(imported.mesh, {0.125f, 0.375f, 0}), red);
  EXPECT_EQ(surface_color(imported.mesh, {0.375f, 0.375f, 0}), green);
  EXPECT_EQ(surface_color(imported.mesh, {0.625f, 0.375f, 0}), green) << "mirrored along u";
  EXPECT_EQ(surface_color(imported.mesh, {0.625f, 0.625f, 0}), green) << "clamped along v";
  EXPECT_EQ(surface_color(imported.mesh, {0.875f, 0.875f, 0}), red);
}

TEST_F(DaeFile, TakesTheSetOfCoordinatesThatItsInstanceBinds) {
  cv::Mat3b picture(4, 4, cv::Vec3b(0, 0, 200));
  const std::vector<unsigned char> bytes = encode_image(".png", picture);
  write_file(folder_.path() / "my picture.png", std::string(bytes.begin(), bytes.end()));
  // Names with numbers are names: the mesh has one set.
  for (const char* name : {"UVMap", "CHANNEL1", "map20_of_7"}) {
    DaeContent content{.effect = kTextured, .parameters = kSampler, .sections = kImages};
    content.effect.replace(content.effect.find("UVMap"), 5, name);
    EXPECT_EQ(surface_color(import(content).mesh, {0.5f, 0.25f, 0}), Eigen::Vector3f(200, 0, 0))
        << name;
  }
}

TEST_F(DaeFile, NamesWhatIsNotRead) {
  EXPECT_THAT(
      notes({.effect = "<phong><emission><color>0 1 0 1</color></emission><diffuse><color>1 0 0 1"
                       "</color></diffuse><specular><texture texture='s' texcoord='t'/></specular>"
                       "</phong>",
             .sections = "<library_animations><animation id='a'/></library_animations>"
                         "<library_lights><light id='l'/></library_lights>"
                         "<library_mine><mine id='x'/></library_mine>"}),
      ElementsAre("it has <library_animations>, which is not read",
                  "it has <library_mine>, which is not read",
                  "material 'label' is not drawn as the file says: <specular> texture, <emission> "
                  "(it adds no light)"));
}

TEST_F(DaeFile, SkinsAreRefusedWithAConversion) {
  const DaeContent content{
      .sections =
          "<library_controllers><controller id='c'><skin source='#g'>"
          "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
          "<source id='j'><Name_array id='ja' count='1'>n</Name_array><technique_common><accessor "
          "source='#ja' count='1' stride='1'><param name='JOINT' type='name'/></accessor>"
          "</technique_common></source>"
          "<source id='b'><float_array id='ba' count='16'>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
          "</float_array><technique_common><accessor source='#ba' count='1' stride='16'>"
          "<param name='TRANSFORM' type='float4x4'/></accessor></technique_common></source>"
          "<source id='w'><float_array id='wa' count='1'>1</float_array><technique_common>"
          "<accessor source='#wa' count='1' stride='1'><param name='WEIGHT' type='float'/>"
          "</accessor></technique_common></source>"
          "<joints><input semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' "
          "source='#b'/></joints><vertex_weights count='4'><input semantic='JOINT' source='#j' "
          "offset='0'/><input semantic='WEIGHT' source='#w' offset='1'/><vcount>1 1 1 1</vcount>"
          "<v>0 0 0 0 0 0 0 0</v></vertex_weights></skin></controller></library_controllers>",
      .instance = "instance_controller url='#c'"};
  EXPECT_THAT(import_error(file(dae(content))),
              AllOf(HasSubstr("it has a skin, and DAE files are read as rigid meshes only"),
                    HasSubstr("; convert the DAE file, for example: blender -b --python-expr"),
                    HasSubstr("filepath='a.glb'")));
}

TEST_F(DaeFile, DamageEndsInOneMessageWithAConversion) {
  const std::string whole = dae({});
  EXPECT_THAT(import_error(file(whole.substr(0, whole.size() / 2))),
              HasSubstr("; convert the DAE file, for example: blender"));
  std::string longer = whole;
  longer.insert(longer.find("0 0 0 1 0 0 1 1 0"), "0 ");
  EXPECT_THAT(import_error(file(longer)),
              HasSubstr("the list 'pa' has 13 numbers, and its count says 12"));
  EXPECT_THAT(import_error(file("<html><body/></html>")),
              HasSubstr("this is no DAE file: it has no <COLLADA> element"));
  EXPECT_THAT(import_error(file(std::string("\xFF\xFE<\0", 4))),
              HasSubstr("this is no DAE file: it is not text in UTF-8"));
  EXPECT_THAT(import_error(file(dae({.asset = "<unit meter='0'/>"}))),
              HasSubstr("its <unit meter=\"0\"> is no length"));
}

}  // namespace
}  // namespace hypotrack::test
