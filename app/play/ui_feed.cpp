#include "play/ui_feed.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cathlab::play {
namespace {

constexpr std::array<std::pair<SDL_Scancode, UiKey>, 23> keys{{{SDL_SCANCODE_TAB, UiKey::tab},
                                                               {SDL_SCANCODE_LEFT, UiKey::left},
                                                               {SDL_SCANCODE_RIGHT, UiKey::right},
                                                               {SDL_SCANCODE_UP, UiKey::up},
                                                               {SDL_SCANCODE_DOWN, UiKey::down},
                                                               {SDL_SCANCODE_PAGEUP, UiKey::page_up},
                                                               {SDL_SCANCODE_PAGEDOWN, UiKey::page_down},
                                                               {SDL_SCANCODE_HOME, UiKey::home},
                                                               {SDL_SCANCODE_END, UiKey::end},
                                                               {SDL_SCANCODE_INSERT, UiKey::insert},
                                                               {SDL_SCANCODE_DELETE, UiKey::del},
                                                               {SDL_SCANCODE_BACKSPACE, UiKey::backspace},
                                                               {SDL_SCANCODE_SPACE, UiKey::space},
                                                               {SDL_SCANCODE_RETURN, UiKey::enter},
                                                               {SDL_SCANCODE_RETURN2, UiKey::enter},
                                                               {SDL_SCANCODE_ESCAPE, UiKey::escape},
                                                               {SDL_SCANCODE_KP_ENTER, UiKey::keypad_enter},
                                                               {SDL_SCANCODE_A, UiKey::a},
                                                               {SDL_SCANCODE_C, UiKey::c},
                                                               {SDL_SCANCODE_V, UiKey::v},
                                                               {SDL_SCANCODE_X, UiKey::x},
                                                               {SDL_SCANCODE_Y, UiKey::y},
                                                               {SDL_SCANCODE_Z, UiKey::z}}};

constexpr std::array<std::pair<int, UiNav>, 8> buttons{{{SDL_CONTROLLER_BUTTON_A, UiNav::activate},
                                                        {SDL_CONTROLLER_BUTTON_B, UiNav::cancel},
                                                        {SDL_CONTROLLER_BUTTON_DPAD_LEFT, UiNav::left},
                                                        {SDL_CONTROLLER_BUTTON_DPAD_RIGHT, UiNav::right},
                                                        {SDL_CONTROLLER_BUTTON_DPAD_UP, UiNav::up},
                                                        {SDL_CONTROLLER_BUTTON_DPAD_DOWN, UiNav::down},
                                                        {SDL_CONTROLLER_BUTTON_LEFTSHOULDER, UiNav::previous},
                                                        {SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, UiNav::next}}};

constexpr int mouse_index(Uint8 button) {
    switch (button) {
        case SDL_BUTTON_LEFT: return 0;
        case SDL_BUTTON_RIGHT: return 1;
        case SDL_BUTTON_MIDDLE: return 2;
        default: return -1;
    }
}

std::size_t at(UiNav nav) {
    return static_cast<std::size_t>(nav);
}

}  // namespace

void UiFeed::feed(const SDL_Event& event, float scale_x, float scale_y) {
    switch (event.type) {
        case SDL_MOUSEMOTION:
            input_.mouse_x = scale_x * static_cast<float>(event.motion.x);
            input_.mouse_y = scale_y * static_cast<float>(event.motion.y);
            break;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP: {
            input_.mouse_x = scale_x * static_cast<float>(event.button.x);
            input_.mouse_y = scale_y * static_cast<float>(event.button.y);
            const int index = mouse_index(event.button.button);
            if (index < 0) break;
            const bool down = event.type == SDL_MOUSEBUTTONDOWN;
            input_.mouse[static_cast<std::size_t>(index)] = down;
            if (down) tapped_[static_cast<std::size_t>(index)] = true;
            break;
        }
        case SDL_MOUSEWHEEL: input_.wheel += static_cast<float>(event.wheel.y); break;
        case SDL_TEXTINPUT: input_.text += event.text.text; break;
        case SDL_KEYDOWN:
        case SDL_KEYUP: {
            const bool down = event.type == SDL_KEYDOWN;
            input_.shift = (event.key.keysym.mod & KMOD_SHIFT) != 0;
            input_.control = (event.key.keysym.mod & KMOD_CTRL) != 0;
            for (const auto& [code, key] : keys) {
                if (event.key.keysym.scancode != code) continue;
                input_.keys[static_cast<std::size_t>(key)] = down;
                if (down) key_tapped_[static_cast<std::size_t>(key)] = true;
            }
            break;
        }
        case SDL_CONTROLLERBUTTONDOWN:
        case SDL_CONTROLLERBUTTONUP:
            for (const auto& [button, nav] : buttons) {
                if (event.cbutton.button != button) continue;
                input_.nav[at(nav)] = event.type == SDL_CONTROLLERBUTTONDOWN ? 1.0F : 0.0F;
                if (event.type == SDL_CONTROLLERBUTTONDOWN) nav_tapped_[at(nav)] = 1.0F;
            }
            break;
        case SDL_CONTROLLERAXISMOTION: {
            const bool x = event.caxis.axis == SDL_CONTROLLER_AXIS_LEFTX;
            if (!x && event.caxis.axis != SDL_CONTROLLER_AXIS_LEFTY) break;
            stick_[at(x ? UiNav::left : UiNav::up)] = event.caxis.value < -16000 ? 1.0F : 0.0F;
            stick_[at(x ? UiNav::right : UiNav::down)] = event.caxis.value > 16000 ? 1.0F : 0.0F;
            break;
        }
        case SDL_CONTROLLERDEVICEREMOVED:
            input_.nav.fill(0.0F);
            stick_.fill(0.0F);
            break;
        case SDL_WINDOWEVENT:
            if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) release();
            if (event.window.event == SDL_WINDOWEVENT_LEAVE) input_.mouse_x = input_.mouse_y = -1e6F;
            break;
        default: break;
    }
}

UiInput UiFeed::take() {
    UiInput out = input_;
    for (std::size_t i = 0; i < tapped_.size(); ++i) out.mouse[i] = out.mouse[i] || tapped_[i];
    for (std::size_t i = 0; i < key_tapped_.size(); ++i) out.keys[i] = out.keys[i] || key_tapped_[i];
    for (std::size_t i = 0; i < nav_tapped_.size(); ++i) out.nav[i] = std::max({out.nav[i], nav_tapped_[i], stick_[i]});
    // The return key does what A does.
    if (out.keys[static_cast<std::size_t>(UiKey::enter)]) out.nav[at(UiNav::activate)] = 1.0F;
    input_.wheel = 0.0F;
    input_.text.clear();
    tapped_.fill(false);
    key_tapped_.fill(false);
    nav_tapped_.fill(0.0F);
    return out;
}

void UiFeed::release() {
    const float x = input_.mouse_x, y = input_.mouse_y;
    input_ = {};
    input_.mouse_x = x;
    input_.mouse_y = y;
    stick_.fill(0.0F);
    tapped_.fill(false);
    key_tapped_.fill(false);
    nav_tapped_.fill(0.0F);
}

}  // namespace cathlab::play
