#include "producers/camera/view/picture_window.h"

#include <epoxy/gl.h>
// OpenGL's functions come from epoxy.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace dance {

struct PictureWindow::Parts {
  GLFWwindow* window = nullptr;
  GLuint texture = 0;
  GLuint target = 0;
  int width_px = 0;  // of the texture
  int height_px = 0;
};

Result<std::unique_ptr<PictureWindow>> PictureWindow::open(const std::string& title, int width_px,
                                                           int height_px) {
  std::unique_ptr<PictureWindow> made(new PictureWindow);
  made->parts_ = std::make_unique<Parts>();
  const char* why = nullptr;
  if (!glfwInit()) {
    glfwGetError(&why);
    return fail(std::string("there is no display for the preview (") +
                (why ? why : "GLFW does not start") +
                "); --preview-file FILE.jpg writes it as a picture instead");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  Parts& parts = *made->parts_;
  parts.window = glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr);
  if (!parts.window) {
    glfwGetError(&why);
    return fail(std::string("no window for the preview (") + (why ? why : "OpenGL 3.3 is missing") +
                "); --preview-file FILE.jpg writes it as a picture instead");
  }
  glfwMakeContextCurrent(parts.window);
  // Not at the display's pace: for a hidden window some wait for ever, and the preview could not
  // end.
  glfwSwapInterval(0);
  glGenTextures(1, &parts.texture);
  glGenFramebuffers(1, &parts.target);
  return made;
}

PictureWindow::~PictureWindow() {
  if (parts_ && parts_->window) {
    glDeleteFramebuffers(1, &parts_->target);
    glDeleteTextures(1, &parts_->texture);
    glfwDestroyWindow(parts_->window);
  }
  glfwTerminate();
}

void PictureWindow::show(const cv::Mat& picture) {
  Parts& parts = *parts_;
  glBindTexture(GL_TEXTURE_2D, parts.texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(picture.step[0] / 3));
  if (picture.cols != parts.width_px || picture.rows != parts.height_px) {
    parts.width_px = picture.cols;
    parts.height_px = picture.rows;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture.cols, picture.rows, 0, GL_BGR, GL_UNSIGNED_BYTE,
                 picture.data);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, parts.target);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, parts.texture,
                           0);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.cols, picture.rows, GL_BGR, GL_UNSIGNED_BYTE,
                    picture.data);
  }
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(parts.window, &width, &height);
  const double scale = std::min(static_cast<double>(width) / picture.cols,
                                static_cast<double>(height) / picture.rows);
  const int w = static_cast<int>(std::lround(picture.cols * scale));
  const int h = static_cast<int>(std::lround(picture.rows * scale));
  const int x = (width - w) / 2;
  const int y = (height - h) / 2;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glClearColor(0.08f, 0.08f, 0.09f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, parts.target);
  // Row 0 of a picture is its top, of a window its bottom.
  glBlitFramebuffer(0, picture.rows, picture.cols, 0, x, y, x + w, y + h, GL_COLOR_BUFFER_BIT,
                    GL_LINEAR);
  glfwSwapBuffers(parts.window);
}

bool PictureWindow::is_open() {
  glfwPollEvents();
  return !glfwWindowShouldClose(parts_->window);
}

}  // namespace dance
