#version 450
// A kernel that states its own version, and no push constants.
layout(local_size_x = 1) in;
buffer Target { float target[]; };
void main() {
  target[0] = 1.0;
#ifdef BREAK
  target[1] = mistake;
#endif
}
