// A fragment that is to arrive in one sample.
layout(location = 0) out uint arrived;

void main() {
  arrived = 1u;
}
