"""VirtualHome's own interfaces: the messages of its Unity simulator, and the classes of its symbolic half."""
