"""What is wrong with a program, and corrections that are safe."""
