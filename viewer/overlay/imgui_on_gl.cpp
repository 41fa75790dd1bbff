#include "viewer/overlay/imgui_on_gl.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <string>

#include "viewer/gl/gl_objects.h"

namespace dance {

ImguiOnGl::ImguiOnGl() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
}

ImguiOnGl::~ImguiOnGl() {
  if (has_begun_) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

Result<void> ImguiOnGl::begin(const char* what) {
  has_begun_ = ImGui_ImplOpenGL3_Init("#version 330 core");
  if (has_begun_) return {};
  return fail(std::string(what) +
              " cannot be drawn: ImGui finds no OpenGL; install libgl1 with apt-get");
}

void ImguiOnGl::renew_fonts() {
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void ImguiOnGl::begin_frame(int width_px, int height_px, float since_last_s) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width_px), static_cast<float>(height_px));
  io.DeltaTime = since_last_s;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void ImguiOnGl::end_frame() {
  ImGui::Render();
  glUseProgram(0);  // ImGui would put back one that has been deleted meanwhile
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  check_gl("ImGui");
}

}  // namespace dance
