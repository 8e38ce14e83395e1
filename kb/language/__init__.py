"""Between steps and sentences: phrases, language understanding, plans in natural language."""
