// For draws of which only the stencil test counts.
void main() {}
