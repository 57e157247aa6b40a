#include "app/paper_tables.h"

#include <functional>

namespace sfumato::app {
namespace {

using pipelines::ShadowKind;
using Figures = std::vector<std::vector<double>>;

// ---- Aladagli 2015
// -----------------------------------------------------------------------------------------

// Section 4.3: opaque and translucent triangles of its three scenes.
constexpr scene::TriangleCounts halls[] = {{38812, 20832}, {49210, 10434}, {59644, 0}};

PaperSetting inHall(int lights, const scene::TriangleCounts& hall = halls[0]) {
  return {.opaque = hall.opaque, .translucent = hall.translucent, .lights = lights, .pipeline = "interlaced"};
}

PaperSetting refracting(PaperSetting setting, bool shadows) {
  setting.refraction = true;
  setting.shadows = shadows ? ShadowKind::Interlaced : ShadowKind::None;
  return setting;
}

// Settings of a table whose rows are numbers of lights.
PaperTable lightsTable(const char* number, const char* title, std::vector<std::string> columns,
                       std::vector<int> lights, Figures figures,
                       const std::function<PaperSetting(int lights, size_t column)>& settingOf) {
  PaperTable table{.paper = "metu",
                   .number = number,
                   .title = title,
                   .rowTitle = "lights",
                   .columns = std::move(columns),
                   .figures = std::move(figures)};
  for (const int count : lights) {
    table.rows.push_back(std::to_string(count));
    std::vector<PaperSetting>& settings = table.settings.emplace_back();
    for (size_t column = 0; column < table.columns.size(); ++column)
      settings.push_back(settingOf(count, column));
  }
  return table;
}

// Tables 4.4 and 4.5.
PaperTable pipelinesTable(const char* number, const char* title, bool shadows, Figures figures) {
  return lightsTable(number, title, {"interlaced", "peeling", "forward", "forward-mask"},
                     {2, 4, 8, 16, 32, 64}, std::move(figures), [=](int lights, size_t column) {
                       const char* const names[] = {"interlaced", "peeling", "forward", "forward-mask"};
                       PaperSetting setting = refracting(inHall(lights), shadows);
                       setting.pipeline = names[column];
                       setting.layers = column == 1 ? 1 : 0;
                       return setting;
                     });
}

// Tables 4.6 and 4.7.
PaperTable scenesTable(const char* number, const char* title, bool shadows, Figures figures) {
  return lightsTable(
      number, title, {"scene 1", "scene 2", "scene 3"}, {2, 4, 8, 16, 32, 64}, std::move(figures),
      [=](int lights, size_t column) { return refracting(inHall(lights, halls[column]), shadows); });
}

// Tables 4.8 and 4.9: of machines, of which only the growth with the lights compares.
PaperTable machinesTable(const char* number, const char* title, bool shadows, Figures figures) {
  PaperTable table =
      lightsTable(number, title, {"GTX 760", "GTX 690", "GTX 780"}, {2, 4, 8, 16, 32, 64}, std::move(figures),
                  [=](int lights, size_t) { return refracting(inHall(lights), shadows); });
  table.baselineRows.assign(table.rows.size(), 0);
  return table;
}

std::vector<PaperTable> metuTables() {
  const std::vector<int> all = {0, 2, 4, 8, 16, 32, 64};
  return {
      lightsTable("4.2", "with and without refraction", {"no effects", "refraction"}, all,
                  {{564, 499}, {490, 440}, {438, 397}, {364, 338}, {331, 306}, {283, 265}, {148, 142}},
                  [](int lights, size_t column) {
                    PaperSetting setting = inHall(lights);
                    setting.refraction = column == 1;
                    return setting;
                  }),
      lightsTable("4.3", "opaque and transparent shadows", {"opaque", "transparent"}, {2, 4, 8, 16, 32, 64},
                  {{394, 343}, {311, 254}, {226, 173}, {163, 114}, {108, 71}, {53, 35}},
                  [](int lights, size_t column) {
                    PaperSetting setting = inHall(lights);
                    setting.shadows = column == 0 ? ShadowKind::Opaque : ShadowKind::Interlaced;
                    return setting;
                  }),
      pipelinesTable("4.4", "four pipelines with shadows", true,
                     {{318, 197, 390, 423},
                      {240, 154, 255, 268},
                      {166, 111, 154, 156},
                      {111, 80, 83, 84},
                      {69, 53, 44, 44},
                      {32, 26, 23, 23}}),
      pipelinesTable("4.5", "four pipelines without shadows", false,
                     {{441, 239, 526, 588},
                      {398, 213, 375, 406},
                      {337, 178, 234, 246},
                      {308, 162, 132, 135},
                      {266, 138, 70, 72},
                      {143, 71, 37, 37}}),
      scenesTable(
          "4.6", "three scenes with shadows", true,
          {{318, 319, 320}, {240, 241, 241}, {166, 166, 166}, {111, 111, 111}, {69, 70, 70}, {32, 34, 34}}),
      scenesTable("4.7", "three scenes without shadows", false,
                  {{441, 443, 444},
                   {398, 400, 401},
                   {337, 338, 339},
                   {308, 310, 309},
                   {266, 265, 268},
                   {143, 142, 139}}),
      machinesTable(
          "4.8", "growth with the lights, with shadows", true,
          {{318, 367, 444}, {240, 265, 332}, {166, 183, 225}, {111, 122, 149}, {69, 76, 90}, {32, 37, 46}}),
      machinesTable("4.9", "growth with the lights, without shadows", false,
                    {{441, 506, 624},
                     {398, 438, 571},
                     {337, 365, 511},
                     {308, 324, 473},
                     {266, 279, 421},
                     {143, 147, 239}}),
  };
}

// ---- Ferko 2012
// --------------------------------------------------------------------------------------------

// Section 7: all triangles of its scenes; how many of them were translucent it does not say.
struct CescgScene {
  const char* name;
  PaperScene scene;
  scene::TriangleCounts triangles;
};
constexpr CescgScene cescgScenes[] = {{"Sponza", PaperScene::Court, {287353 - 24000, 24000}},
                                      {"Dragon", PaperScene::Statue, {201075, 0}},
                                      {"House", PaperScene::House, {11563 - 1200, 1200}}};

PaperSetting inCescg(const CescgScene& place, bool occlusion, bool translucent, int preset) {
  constexpr int widths[] = {800, 1280, 1920}, heights[] = {600, 720, 1080}, texels[] = {512, 1024, 2048};
  return {.scene = place.scene,
          .opaque = place.triangles.opaque,
          .translucent = place.triangles.translucent,
          .drawsTranslucent = translucent,
          .pipeline = "stencil-routed",
          .shadows = ShadowKind::Opaque,
          .ambientOcclusion = occlusion,
          .preset = preset,
          .width = widths[preset],
          .height = heights[preset],
          .shadowTexels = texels[preset]};
}

PaperTable cescgTable() {
  PaperTable table{.paper = "cescg",
                   .number = "1",
                   .title = "ambient occlusion and translucent objects",
                   .rowTitle = "scene and preset",
                   .columns = {"low", "medium", "high"}};
  const auto add = [&](const CescgScene& place, const char* preset, bool occlusion, bool translucent,
                       std::vector<double> figures) {
    table.rows.push_back(std::string(place.name) + ", " + preset);
    table.figures.push_back(std::move(figures));
    std::vector<PaperSetting>& settings = table.settings.emplace_back();
    for (int column = 0; column < 3; ++column)
      settings.push_back(inCescg(place, occlusion, translucent, column));
  };
  const auto& [sponza, dragon, house] = cescgScenes;
  add(sponza, "SSAO + SR", true, true, {18.7, 10.9, 3.0});
  add(sponza, "SSAO", true, false, {20.9, 13.8, 3.6});
  add(sponza, "SR", false, true, {19.7, 15.8, 10.7});
  add(sponza, "OFF", false, false, {24.7, 21.3, 14.6});
  add(dragon, "SSAO", true, false, {38.1, 19.1, 3.8});
  add(dragon, "OFF", false, false, {49.6, 36.2, 21.2});
  add(house, "SSAO + SR", true, true, {46.7, 18.3, 3.9});
  add(house, "SSAO", true, false, {60.1, 26.0, 4.6});
  add(house, "SR", false, true, {67.5, 32.7, 17.8});
  add(house, "OFF", false, false, {95.0, 60.0, 36.3});
  table.baselineRows = {3, 3, 3, 3, 5, 5, 9, 9, 9, 9};
  return table;
}

scene::GeneratedScene generated(const PaperSetting& setting) {
  const scene::TriangleCounts triangles{setting.opaque, setting.translucent};
  const double aspect = static_cast<double>(setting.width) / setting.height;
  switch (setting.scene) {
    case PaperScene::Court:
      return scene::courtScene(triangles, aspect);
    case PaperScene::Statue:
      return scene::statueScene(triangles, aspect);
    case PaperScene::House:
      return scene::houseScene(triangles, aspect);
    default:
      return scene::hallScene(triangles, setting.lights, aspect);
  }
}

}  // namespace

std::vector<PaperTable> paperTables() {
  std::vector<PaperTable> tables = metuTables();
  tables.push_back(cescgTable());
  return tables;
}

scene::GeneratedScene sceneOf(const PaperSetting& setting) {
  scene::GeneratedScene made = generated(setting);
  if (!setting.drawsTranslucent) made.scene = scene::withoutTranslucent(made.scene);
  return made;
}

}  // namespace sfumato::app
