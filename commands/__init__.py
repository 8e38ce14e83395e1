"""The command line, one file a group of commands: options, one library call, print."""
