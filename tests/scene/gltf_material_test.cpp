// One file of more than 400 lines, since all tests of materials use the builders below.
#include "tests/scene/gltf_builder.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

// A 1 x 1 image of that colour as a data URI.
std::string png_uri(const std::string& rgba) { return "data:image/png;base64," + base64(png_bytes(1, 1, 8, 6, rgba)); }

// One triangle with material 0; texture 0 shows image 0.
GltfBuilder textured_triangle(const json& material) {
    GltfBuilder gltf = one_triangle();
    gltf.root["materials"] = json::array({material});
    gltf.root["images"] = {{{"uri", png_uri("\x01\x02\x03\x04")}}};
    gltf.root["textures"] = {{{"source", 0}}};
    gltf.primitive()["material"] = 0;
    return gltf;
}

GltfBuilder with_base_color_texture() {
    return textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
}

TEST(GltfMaterial, FactorsAndModesAreTaken) {
    const Scene scene =
        textured_triangle(
            {{"name", "paint"},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
             {"emissiveFactor", {0.25, 0.5, 1}},
             {"alphaMode", "MASK"},
             {"alphaCutoff", 0.75},
             {"doubleSided", true}})
            .load();
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.base_color, vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.6f);
    EXPECT_EQ(material.emission, vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(material.alpha_cutoff, 0.75f);
    EXPECT_TRUE(material.double_sided);
    EXPECT_FALSE(material.unlit);
    EXPECT_EQ(material.base_color_texture.image, -1);
}

TEST(GltfMaterial, ExtensionsAreTaken) {
    const Material material =
        textured_triangle({{"emissiveFactor", {1, 0.5, 0}},
                           {"alphaMode", "BLEND"},
                           {"extensions",
                            {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
                             {"KHR_materials_ior", {{"ior", 1.25}}},
                             {"KHR_materials_unlit", json::object()},
                             {"KHR_materials_transmission",
                              {{"transmissionFactor", 0.5}, {"transmissionTexture", {{"index", 0}}}}}}}})
            .load()
            .materials[0];
    EXPECT_EQ(material.emission, vec3(4, 2, 0));
    EXPECT_EQ(material.ior, 1.25f);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(material.transmission, 0.5f);
    EXPECT_EQ(material.transmission_texture.image, 0);
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
}

TEST(GltfMaterial, LayersAreTaken) {
    const json texture = {{"index", 0}}, scaled = {{"index", 0}, {"scale", 0.25}};
    const Material material =
        textured_triangle(
            {{"extensions",
              {{"KHR_materials_specular",
                {{"specularFactor", 0.5},
                 {"specularColorFactor", {0.25, 2, 1}},
                 {"specularTexture", texture},
                 {"specularColorTexture", texture}}},
               {"KHR_materials_clearcoat",
                {{"clearcoatFactor", 0.5},
                 {"clearcoatRoughnessFactor", 0.25},
                 {"clearcoatTexture", texture},
                 {"clearcoatRoughnessTexture", texture},
                 {"clearcoatNormalTexture", scaled}}},
               {"KHR_materials_sheen",
                {{"sheenColorFactor", {0.25, 0.5, 1}},
                 {"sheenRoughnessFactor", 0.75},
                 {"sheenColorTexture", texture},
                 {"sheenRoughnessTexture", texture}}},
               {"KHR_materials_anisotropy",
                {{"anisotropyStrength", 0.5}, {"anisotropyRotation", -7}, {"anisotropyTexture", texture}}},
               {"KHR_materials_volume",
                {{"thicknessFactor", 3}, {"attenuationColor", {0.5, 0.25, 1}}, {"attenuationDistance", 2}}}}}})
            .load()
            .materials[0];
    EXPECT_EQ(material.specular, 0.5f);
    EXPECT_EQ(material.specular_color, vec3(0.25f, 2, 1));
    EXPECT_EQ(material.clearcoat, 0.5f);
    EXPECT_EQ(material.clearcoat_roughness, 0.25f);
    EXPECT_EQ(material.clearcoat_normal_scale, 0.25f);
    EXPECT_EQ(material.sheen_color, vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(material.sheen_roughness, 0.75f);
    EXPECT_EQ(material.anisotropy, 0.5f);
    EXPECT_EQ(material.anisotropy_rotation, -7);
    EXPECT_EQ(material.thickness, 3);
    EXPECT_EQ(material.attenuation_color, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(material.attenuation_distance, 2);
    for (const Texture* read :
         {&material.specular_texture, &material.specular_color_texture, &material.clearcoat_texture,
          &material.clearcoat_roughness_texture, &material.clearcoat_normal_texture, &material.sheen_color_texture,
          &material.sheen_roughness_texture, &material.anisotropy_texture})
        EXPECT_EQ(read->image, 0);
}

TEST(GltfMaterial, LayersThatAreNamedButNotGivenChangeNothing) {
    const Material material = textured_triangle({{"extensions",
                                                  {{"KHR_materials_specular", json::object()},
                                                   {"KHR_materials_clearcoat", json::object()},
                                                   {"KHR_materials_sheen", json::object()},
                                                   {"KHR_materials_anisotropy", json::object()},
                                                   {"KHR_materials_volume", json::object()}}}})
                                  .load()
                                  .materials[0];
    EXPECT_EQ(material.specular, 1);
    EXPECT_EQ(material.specular_color, vec3(1));
    EXPECT_EQ(material.clearcoat, 0);
    EXPECT_EQ(material.sheen_color, vec3(0));
    EXPECT_EQ(material.anisotropy, 0);
    EXPECT_EQ(material.thickness, 0);
    EXPECT_EQ(material.attenuation_distance, INFINITY);
}

TEST(GltfMaterial, LayersOutsideOfTheirRangeAreClamped) {
    const Material material =
        textured_triangle({{"extensions",
                            {{"KHR_materials_specular", {{"specularFactor", 2}, {"specularColorFactor", {-1, 2, 0}}}},
                             {"KHR_materials_clearcoat", {{"clearcoatFactor", 2}, {"clearcoatRoughnessFactor", -1}}},
                             {"KHR_materials_sheen", {{"sheenColorFactor", {2, -1, 0}}}},
                             {"KHR_materials_anisotropy", {{"anisotropyStrength", 3}}},
                             {"KHR_materials_volume", {{"thicknessFactor", -1}, {"attenuationDistance", 0}}}}}})
            .load()
            .materials[0];
    EXPECT_EQ(material.specular, 1);
    EXPECT_EQ(material.specular_color, vec3(0, 2, 0));
    EXPECT_EQ(material.clearcoat, 1);
    EXPECT_EQ(material.clearcoat_roughness, 0);
    EXPECT_EQ(material.sheen_color, vec3(1, 0, 0));
    EXPECT_EQ(material.anisotropy, 1);
    EXPECT_EQ(material.thickness, 0);
    EXPECT_GT(material.attenuation_distance, 0);
}

TEST(GltfMaterial, WhatIsNotShownIsNamedOnce) {
    GltfBuilder gltf = textured_triangle(
        {{"extensions", {{"KHR_materials_iridescence", json::object()}, {"KHR_materials_sheen", json::object()}}}});
    gltf.root["extensionsUsed"] = {"KHR_materials_iridescence", "KHR_materials_dispersion", "KHR_materials_sheen",
                                   "KHR_materials_diffuse_transmission"};
    EXPECT_EQ(gltf.load().warnings,
              (std::vector<std::string>{"shown without the glTF extensions KHR_materials_diffuse_transmission, "
                                        "KHR_materials_dispersion, KHR_materials_iridescence"}));
}

TEST(GltfMaterial, SpecularGlossinessIsShown) {
    const Scene scene = textured_triangle({{"extensions",
                                            {{"KHR_materials_pbrSpecularGlossiness",
                                              {{"diffuseFactor", {0.5, 0.25, 0, 1}},
                                               {"glossinessFactor", 0.75},
                                               {"diffuseTexture", {{"index", 0}}}}}}}})
                            .load();
    EXPECT_EQ(scene.materials[0].base_color, vec4(0.5f, 0.25f, 0, 1));
    EXPECT_EQ(scene.materials[0].metallic, 0);
    EXPECT_EQ(scene.materials[0].roughness, 0.25f);
    EXPECT_EQ(scene.materials[0].base_color_texture.image, 0);
    EXPECT_EQ(scene.materials[0].ior, 0);
    EXPECT_EQ(scene.materials[0].specular_color, vec3(1));
    EXPECT_FALSE(has_warning(scene, "pbrSpecularGlossiness"));
}

TEST(GltfMaterial, SpecularGlossinessWithoutFactorsIsSmoothAndWhite) {
    const json empty = {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", json::object()}}}};
    const Material material = textured_triangle(empty).load().materials[0];
    EXPECT_EQ(material.roughness, 0);
    EXPECT_EQ(material.base_color, vec4(1));
    EXPECT_EQ(material.specular_color, vec3(1));
}

// Roughness is 1 - factor * alpha; the alpha of the picture is 4.
TEST(GltfMaterial, GlossinessInAlphaBecomesRoughness) {
    const auto load = [](double factor) {
        return textured_triangle({{"extensions",
                                   {{"KHR_materials_pbrSpecularGlossiness",
                                     {{"glossinessFactor", factor},
                                      {"specularFactor", {0.5, 1, 1}},
                                      {"specularGlossinessTexture", {{"index", 0}}}}}}}})
            .load();
    };
    const Scene scene = load(0.5);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.specular_color, vec3(0.5f, 1, 1));
    EXPECT_EQ(material.specular_color_texture.image, 0);
    const Image& given = scene.images[0];
    EXPECT_EQ(material.roughness, 1);
    ASSERT_EQ(material.metallic_roughness_texture.image, 1);
    for (std::size_t i = 0; i < given.rgba.size(); i += 4)
        EXPECT_EQ(scene.images[1].rgba[i + 1], std::lround(255 - 0.5f * given.rgba[i + 3]));
}

TEST(GltfMaterial, OnePictureHasARoughnessForEachFactorOfGlossiness) {
    const auto material = [](double factor) {
        return json{{"extensions",
                     {{"KHR_materials_pbrSpecularGlossiness",
                       {{"glossinessFactor", factor}, {"specularGlossinessTexture", {{"index", 0}}}}}}}};
    };
    GltfBuilder gltf = textured_triangle(material(0.5));
    gltf.root["materials"].push_back(material(1));
    gltf.root["materials"].push_back(material(0.5));
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.materials[0].metallic_roughness_texture.image, 1);
    EXPECT_EQ(scene.materials[1].metallic_roughness_texture.image, 2);
    EXPECT_EQ(scene.materials[2].metallic_roughness_texture.image, 1);
}

TEST(GltfMaterial, FactorsOutsideOfTheirRangeAreClamped) {
    const Material material =
        textured_triangle({{"pbrMetallicRoughness", {{"metallicFactor", 2}, {"roughnessFactor", -1}}},
                           {"emissiveFactor", {-1, 3, 0}}})
            .load()
            .materials[0];
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 0);
    EXPECT_EQ(material.emission, vec3(0, 1, 0));
}

TEST(GltfMaterial, AllFiveTexturesFindTheirImage) {
    GltfBuilder gltf = textured_triangle(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
         {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
         {"emissiveTexture", {{"index", 1}}}});
    gltf.root["images"].push_back({{"uri", png_uri("\x09\x09\x09\x09")}});
    gltf.root["textures"].push_back({{"source", 1}});
    const Scene scene = gltf.load();
    const Material& material = scene.materials[0];
    ASSERT_EQ(scene.images.size(), 2u);  // each once, though four textures use them
    EXPECT_EQ(material.base_color_texture.image, material.normal_texture.image);
    EXPECT_EQ(material.metallic_roughness_texture.image, material.emission_texture.image);
    EXPECT_EQ(material.normal_scale, 0.5f);
    EXPECT_EQ(scene.images[std::size_t(material.normal_texture.image)].rgba, (std::vector<std::uint8_t>{1, 2, 3, 4}));
    EXPECT_EQ(scene.images[std::size_t(material.emission_texture.image)].rgba, (std::vector<std::uint8_t>{9, 9, 9, 9}));
}

TEST(GltfMaterial, UnusedImagesAreNotDecoded) {
    GltfBuilder gltf = textured_triangle(json::object());
    gltf.root["images"].push_back({{"uri", "missing.png"}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.images.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterial, ImagesMayLieInABufferView) {
    GltfBuilder gltf = with_base_color_texture();
    gltf.root["images"][0] = {{"bufferView", gltf.add_view(png_bytes(1, 1, 8, 6, "abcd"))}, {"mimeType", "image/png"}};
    EXPECT_EQ(gltf.load().images[0].rgba, (std::vector<std::uint8_t>{'a', 'b', 'c', 'd'}));
}

TEST(GltfMaterial, WrapModesComeFromTheSampler) {
    GltfBuilder gltf = with_base_color_texture();
    EXPECT_EQ(gltf.load().materials[0].base_color_texture.wrap_u, Wrap::repeat);
    gltf.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    gltf.root["textures"][0]["sampler"] = 0;
    const Texture texture = gltf.load().materials[0].base_color_texture;
    EXPECT_EQ(texture.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(texture.wrap_v, Wrap::mirrored_repeat);
}

// The numbers of Khronos' TextureTransformTest: there, the mark "correct" lies at uv (0.421, 1.016) of the rotated
// quad, and the image has its arrow on the diagonal u = v.
TEST(GltfMaterial, TextureTransformsTurnAsTheKhronosSampleDoes) {
    GltfBuilder gltf = with_base_color_texture();
    json& transform =
        gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"];
    transform = {{"rotation", 0.39269908169872414}};
    const Texture rotated = gltf.load().materials[0].base_color_texture;
    const vec3 mark(0.42095178f, 1.01626749f, 1);
    EXPECT_NEAR(dot(rotated.uv_row0, mark), dot(rotated.uv_row1, mark), 1e-6);
    EXPECT_GT(dot(rotated.uv_row0, mark), 0.5f);

    transform = {{"offset", {0.5, -0.25}}, {"scale", {2, 4}}, {"rotation", 1.5707963267948966}};
    const Texture all = gltf.load().materials[0].base_color_texture;
    EXPECT_NEAR(length(all.uv_row0 - vec3(0, 4, 0.5f)), 0, 1e-6);
    EXPECT_NEAR(length(all.uv_row1 - vec3(-2, 0, -0.25f)), 0, 1e-6);
}

// Each texture names a set by itself, those of extensions as well; KHR_texture_transform has the last word.
TEST(GltfMaterial, TexturesNameTheirSetOfTextureCoordinates) {
    const auto texture = [](int set) { return json{{"index", 0}, {"texCoord", set}}; };
    json moved = texture(0);
    moved["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
    GltfBuilder gltf = textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", moved}}},
                                          {"normalTexture", texture(1)},
                                          {"occlusionTexture", texture(1)},
                                          {"emissiveTexture", texture(0)},
                                          {"extensions",
                                           {{"KHR_materials_transmission", {{"transmissionTexture", texture(1)}}},
                                            {"KHR_materials_sheen", {{"sheenColorTexture", moved}}},
                                            {"KHR_materials_clearcoat", {{"clearcoatNormalTexture", texture(1)}}}}}});
    for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"})
        gltf.primitive()["attributes"][name] = gltf.add_floats("VEC2", std::vector<float>(6));
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.warnings.empty()) << testing::PrintToString(scene.warnings);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.base_color_texture.uv_set, 1u);
    EXPECT_EQ(material.normal_texture.uv_set, 1u);
    EXPECT_EQ(material.emission_texture.uv_set, 0u);
    EXPECT_EQ(material.transmission_texture.uv_set, 1u);
    EXPECT_EQ(material.sheen_color_texture.uv_set, 1u);
    EXPECT_EQ(material.clearcoat_normal_texture.uv_set, 1u);
}

TEST(GltfMaterial, TextureCoordinatesThatAreNotThereAreNamed) {
    GltfBuilder gltf = with_base_color_texture();
    const char* lacks = "mesh 0 'tri' primitive 0: lacks the TEXCOORD_";
    json& set = gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"];
    set = 2;
    EXPECT_TRUE(has_warning(gltf.load(), "material 0 baseColorTexture: asks for TEXCOORD_2, shown with TEXCOORD_0"));
    set = 1;
    EXPECT_TRUE(has_warning(gltf.load(), lacks + std::string("1 of material 'material 0', whose textures show one")));
    gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", std::vector<float>(6));
    EXPECT_TRUE(
        has_warning(gltf.load(), lacks + std::string("1 of material 'material 0', whose textures show by TEX")));
    gltf.primitive()["attributes"]["TEXCOORD_1"] = gltf.primitive()["attributes"]["TEXCOORD_0"];
    EXPECT_TRUE(gltf.load().warnings.empty());
    gltf.primitive()["attributes"].erase("TEXCOORD_0");
    EXPECT_TRUE(gltf.load().warnings.empty());
    set = 0;
    EXPECT_TRUE(has_warning(gltf.load(), lacks + std::string("0 of material 'material 0', whose textures show one")));
}

TEST(GltfMaterial, FiltersComeFromTheSampler) {
    GltfBuilder gltf = with_base_color_texture();
    gltf.root["textures"][0]["sampler"] = 0;
    const auto filter = [&](const json& sampler) {
        gltf.root["samplers"] = json::array({sampler});
        return gltf.load().materials[0].base_color_texture.filter;
    };
    EXPECT_EQ(filter({{"magFilter", 9728}, {"minFilter", 9987}}), Filter::nearest);
    EXPECT_EQ(filter({{"magFilter", 9729}, {"minFilter", 9728}}), Filter::linear);
    EXPECT_EQ(filter({{"minFilter", 9728}}), Filter::linear);
}

// Loads an image that cannot be shown and expects a checkerboard and a warning with this text.
void expect_checkerboard(const json& image, const std::string& warning) {
    GltfBuilder gltf = with_base_color_texture();
    gltf.root["images"][0] = image;
    const Scene scene = gltf.load();
    EXPECT_TRUE(has_warning(scene, warning)) << testing::PrintToString(scene.warnings);
    EXPECT_TRUE(has_warning(scene, "checkerboard"));
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 32u);
    EXPECT_EQ(scene.images[0].rgba[0], 255);
    EXPECT_EQ(scene.images[0].rgba[1], 0);
}

// A coat's normal map is left out in the same way.
TEST(GltfMaterial, ANormalMapThatCannotBeReadIsLeftOutWithAWarning) {
    const json map = {{"index", 0}}, coat = {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", map}};
    for (const json& material :
         {json{{"normalTexture", map}}, json{{"extensions", {{"KHR_materials_clearcoat", coat}}}}}) {
        GltfBuilder gltf = textured_triangle(material);
        gltf.root["images"][0] = {{"uri", "missing.png"}};
        const Scene scene = gltf.load();
        EXPECT_TRUE(has_warning(scene, "missing.png': file not found"));
        EXPECT_EQ(scene.materials[0].normal_texture.image, -1);
        EXPECT_EQ(scene.materials[0].clearcoat_normal_texture.image, -1);
    }
}

TEST(GltfMaterial, AnImageThatCannotBeShownIsACheckerboardWithAReason) {
    expect_checkerboard({{"uri", "missing.png"}}, "missing.png': file not found");
    expect_checkerboard({{"uri", "data:image/ktx2;base64," + base64("\xabKTX 20\xbb\r\n\x1a\n")}}, "KTX2");
    expect_checkerboard({{"uri", "data:image/webp;base64," + base64("RIFF....WEBPVP8 ")}}, "WebP");
    expect_checkerboard(
        {{"uri", "data:image/png;base64," + base64(png_bytes(8, 8, 8, 2, std::string(192, 'x')).substr(0, 50))}},
        "damaged PNG");
    expect_checkerboard({{"uri", "data:image/png;base64,"}}, "empty");
    expect_checkerboard({{"uri", "data:image/png;base64,????"}}, "foreign to base64");
    expect_checkerboard({{"uri", "data:image/png,raw"}}, "not base64");
    expect_checkerboard({{"bufferView", 99}}, "bufferView 99 does not exist");
    expect_checkerboard(json::object(), "neither a uri nor a bufferView");
}

TEST(GltfMaterial, ABasisTextureWithAFallbackShowsTheFallback) {
    GltfBuilder gltf = with_base_color_texture();
    gltf.root["textures"][0]["extensions"]["KHR_texture_basisu"] = {{"source", 7}};
    EXPECT_EQ(gltf.load().images[0].rgba, (std::vector<std::uint8_t>{1, 2, 3, 4}));
}

TEST(GltfMaterial, ABasisTextureWithoutAFallbackIsACheckerboard) {
    GltfBuilder gltf = with_base_color_texture();
    gltf.root["images"][0] = {{"uri", "data:image/ktx2;base64," + base64("\xabKTX 20\xbb\r\n\x1a\n")}};
    gltf.root["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    EXPECT_TRUE(has_warning(gltf.load(), "KTX2"));
}

}  // namespace
}  // namespace twinray::test
