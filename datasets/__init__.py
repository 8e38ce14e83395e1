"""What is published, and how it is read: the dataset, tensors, verification, differences."""
