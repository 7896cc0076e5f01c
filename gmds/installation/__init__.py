"""What is on this machine; compiling ahead."""
